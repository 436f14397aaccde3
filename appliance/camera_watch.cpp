#include "appliance/camera_watch.h"

namespace appliance {

std::vector<std::string> CameraWatch::look(const Status& status) {
  std::vector<std::string> lines;
  before_.resize(status.cameras.size());
  for (std::size_t i = 0; i < status.cameras.size(); ++i) {
    const CameraStatus& now = status.cameras[i];
    const CameraStatus& before = before_[i];
    const std::string who = "camera " + std::to_string(i + 1) + " (" + now.name + "): ";
    if (now.state == CameraState::kLost && before.state != CameraState::kLost) {
      lines.push_back(who + "no frames: check its cable, its power and its switch port");
    } else if (now.state == CameraState::kStreaming && before.state == CameraState::kLost) {
      lines.push_back(who + "frames again");
    }
    if (now.state == CameraState::kStreaming && now.frames_lost > before.frames_lost) {
      lines.push_back(who + std::to_string(now.frames_lost - before.frames_lost) +
                      " frames lost: check its cable and the network's load");
    }
  }
  before_ = status.cameras;
  return lines;
}

}  // namespace appliance
