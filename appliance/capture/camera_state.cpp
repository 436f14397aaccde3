#include "appliance/capture/camera_state.h"

#include <array>
#include <cstdio>

namespace appliance {
namespace {

std::string holder(const std::string& detail) {
  return "held by another program" + (detail.empty() ? "" : " at " + detail);
}

std::string wrongOf(const CameraHealth& health) {
  switch (health.trouble) {
    case CameraTrouble::kNone:
      return "";
    case CameraTrouble::kNoAnswer:
      return "check its cable, its power and its switch port";
    case CameraTrouble::kHeld:
      return holder(health.detail) + ": end that program; the camera then comes by itself";
    case CameraTrouble::kRefuses:
      return health.detail;
    case CameraTrouble::kSilent:
      return "it answers: check its trigger wire";
    case CameraTrouble::kGaps:
      return "some triggers bring no frame: check its trigger wire and its frame rate limit";
    case CameraTrouble::kDamaged:
      return "frames come incomplete or in another size: check its cable, its switch port and "
             "its packet size";
    case CameraTrouble::kExtra:
      return "it sends more frames than there are triggers: check its trigger wire for noise";
  }
  return "";
}

}  // namespace

std::string reasonOf(const CameraHealth& health, std::optional<rt::Nanoseconds> silent_for) {
  std::string wrong = wrongOf(health);
  if (health.state != CameraState::kLost) return wrong;
  const bool tells_itself =
      health.trouble == CameraTrouble::kHeld || health.trouble == CameraTrouble::kRefuses;
  if (tells_itself) return wrong;
  std::array<char, 64> silence{};
  if (silent_for) {
    (void)std::snprintf(silence.data(), silence.size(), "no frames since %.1f s",
                        std::chrono::duration<double>(*silent_for).count());
  }
  std::string reason = silent_for                                   ? silence.data()
                       : health.trouble == CameraTrouble::kNoAnswer ? "no answer"
                                                                    : "no frames";
  if (!wrong.empty()) reason += ": " + wrong;
  return reason;
}

}  // namespace appliance
