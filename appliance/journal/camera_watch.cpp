#include "appliance/journal/camera_watch.h"

#include <utility>

namespace appliance {

std::vector<std::string> CameraWatch::look(const Status& status, rt::Timestamp now) {
  std::vector<std::string> lines;
  seen_.resize(status.cameras.size());
  for (std::size_t i = 0; i < status.cameras.size(); ++i) {
    const CameraStatus& camera = status.cameras[i];
    Seen& seen = seen_[i];
    const std::string who = cameraTitle(i, camera.name);
    const std::uint64_t lost_before = std::exchange(seen.frames_lost, camera.frames_lost);

    // What is wrong is known a moment after the silence is; on the way back nothing is told.
    const bool wrong = camera.trouble != CameraTrouble::kNone;
    if (wrong && camera.trouble != seen.told) {
      lines.push_back(who + camera.reason);
      seen.told = camera.trouble;
    } else if (camera.state == CameraState::kStreaming && seen.told != CameraTrouble::kNone) {
      lines.push_back(who + "a frame for every trigger again");
      seen.told = CameraTrouble::kNone;
    }

    if (camera.state != CameraState::kStreaming) continue;
    if (camera.frames_lost > lost_before) seen.untold += camera.frames_lost - lost_before;
    const bool told_lately =
        seen.loss_told_at != rt::Timestamp{} && now - seen.loss_told_at < kLossPeriod;
    if (seen.untold == 0 || told_lately) continue;
    lines.push_back(who + std::to_string(std::exchange(seen.untold, 0)) +
                    " frames lost: check its cable and the network's load");
    seen.loss_told_at = now;
  }
  return lines;
}

}  // namespace appliance
