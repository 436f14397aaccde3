#pragma once

#include <atomic>
#include <cstdint>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/frame_set.h"
#include "appliance/capture/genlock_board.h"
#include "rt/doorbell.h"

namespace appliance {

/// What the collectors of a rig share with the trigger loop and the render thread.
struct CaptureBoard {
  explicit CaptureBoard(std::uint32_t cameras) : sets(cameras) {}

  EdgeBoard edges;
  GenlockBoard genlock;
  FrameSetBoard sets;
  std::atomic<std::uint32_t> shown_camera{0};  ///< whose frames ring the bell; by the render thread
  rt::Doorbell wake_render;                    ///< wakes the render thread
};

}  // namespace appliance
