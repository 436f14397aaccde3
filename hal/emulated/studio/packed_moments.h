#pragma once

#include <span>
#include <vector>

#include "hal/emulated/rig/overlay.h"
#include "hal/emulated/studio/patch.h"
#include "rt/memory.h"
#include "rt/result.h"

namespace emulator::studio {

/// Some moments' pictures in one piece of locked memory, in huge pages where the system has them.
///
/// Each second the sending thread reads some 150 MB of pictures that no cache holds. With pages of
/// 4 KiB it waits for address translations more than for the pixels: on a virtual machine that
/// took a third of its time, and tens of milliseconds in one piece if the host had dropped them.
struct PackedMoments {
  rt::LockedArena memory;
  std::vector<std::vector<Overlay>> overlays;  ///< by moment and camera; they borrow from memory
};

/// Errors   kNoMemory.
[[nodiscard]] rt::Result<PackedMoments> packMoments(std::span<const MomentPatches> moments);

}  // namespace emulator::studio
