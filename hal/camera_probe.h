#pragma once

#include <cstdint>
#include <string>

namespace hal {

/// What one question to a camera's address found out, without opening the camera.
enum class CameraAnswer : std::uint8_t {
  kNone,  ///< nothing answers
  kFree,  ///< it answers, no program controls it
  kHeld,  ///< a program controls it, or one that died and whose control has not timed out yet
  kOurs,  ///< this process controls it
};

struct CameraProbe {
  CameraAnswer answer = CameraAnswer::kNone;
  std::string controller;  ///< address of that program, if the camera reports it; else empty
};

}  // namespace hal
