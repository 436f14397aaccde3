#include "appliance/capture/camera_state.h"

#include <chrono>

namespace appliance {
namespace {

/// What is wrong with a camera that delivers frames, or whose frames do not matter.
Phrase wrongOf(const CameraHealth& health) {
  switch (health.trouble) {
    case CameraTrouble::kNone:
      return {};
    case CameraTrouble::kNoAnswer:
      return phrase<Word::kCameraNoAnswer>();
    case CameraTrouble::kHeld:
      return health.detail.empty() ? phrase<Word::kCameraHeld>()
                                   : phrase<Word::kCameraHeldBy>(health.detail);
    case CameraTrouble::kRefuses:
      return phrase<Word::kCameraRefuses>(health.detail);
    case CameraTrouble::kSilent:
      return phrase<Word::kCameraSilentFromStart>();
    case CameraTrouble::kGaps:
      return phrase<Word::kCameraGaps>();
    case CameraTrouble::kDamaged:
      return phrase<Word::kCameraDamaged>();
    case CameraTrouble::kExtra:
      return phrase<Word::kCameraExtra>();
  }
  return {};
}

/// The same for one that delivered frames and stopped.
Phrase silenceOf(const CameraHealth& health, double seconds) {
  switch (health.trouble) {
    case CameraTrouble::kNone:
      return phrase<Word::kCameraQuiet>(seconds);
    case CameraTrouble::kNoAnswer:
      return phrase<Word::kCameraGone>(seconds);
    case CameraTrouble::kSilent:
      return phrase<Word::kCameraSilent>(seconds);
    case CameraTrouble::kDamaged:
      return phrase<Word::kCameraLostDamaged>(seconds);
    default:
      return wrongOf(health);
  }
}

}  // namespace

Phrase reasonOf(const CameraHealth& health, std::optional<rt::Nanoseconds> silent_for) {
  if (health.state != CameraState::kLost) return wrongOf(health);
  if (silent_for) return silenceOf(health, std::chrono::duration<double>(*silent_for).count());
  return health.trouble == CameraTrouble::kNone ? phrase<Word::kCameraNoFrames>() : wrongOf(health);
}

}  // namespace appliance
