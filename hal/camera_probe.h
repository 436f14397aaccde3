#pragma once

#include <cstdint>
#include <string>

namespace hal {

/// What one question to a camera's address brought, without opening it.
enum class CameraAnswer : std::uint8_t {
  kNone,  ///< nothing answers
  kFree,  ///< it answers, nobody controls it
  kHeld,  ///< somebody controls it: another program, or one that died and whose time still runs
  kOurs,  ///< this process controls it
};

struct CameraProbe {
  CameraAnswer answer = CameraAnswer::kNone;
  std::string controller;  ///< address of who holds it, where the camera tells; else empty
};

}  // namespace hal
