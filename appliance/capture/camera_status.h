#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "appliance/capture/camera_state.h"

namespace appliance {

/// One camera as the outside sees it.
struct CameraStatus {
  std::string name;  ///< as in the rig file
  CameraState state = CameraState::kConnecting;
  CameraTrouble trouble = CameraTrouble::kNone;
  std::string reason;  ///< what is wrong and what to do; empty: nothing
  Word reason_word = Word::kNothing;
  std::uint64_t frames_lost = 0;
  std::uint64_t frames_away = 0;  ///< not taken because the camera was lost
  std::uint64_t frames_incomplete = 0;
};

/// "camera 7 (cam07): ", the beginning of every line about a camera. @p camera: from 0.
[[nodiscard]] inline std::string cameraTitle(std::size_t camera, const std::string& name) {
  return "camera " + std::to_string(camera + 1) + " (" + name + "): ";
}

}  // namespace appliance
