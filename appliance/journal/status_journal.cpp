#include "appliance/journal/status_journal.h"

#include <string>

#include "appliance/journal/status_conditions.h"

namespace appliance {

std::vector<JournalLine> StatusJournal::look(rt::Timestamp now, const Status& status,
                                             std::span<const Condition> more) {
  std::vector<Condition> conditions = conditionsOf(status);
  conditions.insert(conditions.end(), more.begin(), more.end());
  std::vector<JournalLine> lines = conditions_.look(now, conditions);
  for (std::size_t i = 0; i < status.cameras.size(); ++i) {
    const CameraStatus& camera = status.cameras[i];
    const bool streams = camera.state == CameraState::kStreaming;
    const auto lost = losses_.look(now, camera.name, camera.frames_lost, streams);
    if (!lost) continue;
    lines.push_back({LogLevel::kWarning,
                     cameraTitle(i, camera.name) + textOf(phrase<Word::kCameraFramesLost>(*lost)),
                     Word::kCameraFramesLost});
  }
  return lines;
}

}  // namespace appliance
