#include "appliance/box/run_facts.h"

#include <cstdint>
#include <string>
#include <utility>

#include "appliance/capture/camera_status.h"
#include "appliance/trace/process_facts.h"
#include "appliance/version/version.h"
#include "hal/pixel_format.h"

namespace appliance {

void addBoxSections(Status& status, const CommandInbox& commands) {
  status.sections.push_back({.key = "version", .line = std::string(version())});
  StatusSection refused{.key = "commands", .line = ""};
  for (const auto& sender : commands.senders())
    refused.values.push_back(
        {sender->name() + "_refused", static_cast<std::int64_t>(sender->refused())});
  status.sections.push_back(std::move(refused));
}

void remarkTrace(Status& status, const TraceWriter* trace) {
  if (trace == nullptr) return;
  if (const std::string why = trace->failure(); !why.empty())
    status.degraded.push_back(remarkOf("trace", phrase<Word::kTraceFailed>(why)));
}

RunRecord runRecord(const Shared& shared, const Status& status) {
  std::vector<std::string> degraded;
  for (const Remark& remark : status.degraded) degraded.push_back(remark.text);
  for (std::size_t i = 0; const CameraStatus& camera : status.cameras) {
    const std::string who = cameraTitle(i++, camera.name);
    if (!camera.reason.empty()) degraded.push_back(who + camera.reason);
  }
  const hal::DisplayMode mode = shared.display.mode();
  const rt::ArenaReport& memory = shared.history.memory().report();
  return {.version = std::string(version()),
          .cameras = shared.history.cameras(),
          .width_px = shared.rig.cameras.front().width_px,
          .height_px = shared.rig.cameras.front().height_px,
          .pixel_format = hal::genicamName(shared.rig.cameras.front().pixel_format),
          .trigger_hz = shared.config.trigger.rate_hz,
          .display_width_px = mode.width_px,
          .display_height_px = mode.height_px,
          .refresh_hz = mode.refresh_hz,
          .renderer = status.renderer,
          .source_path = status.source_path,
          .history_sets = shared.history.sets(),
          .memory_bytes = memory.bytes,
          .memory_locked = memory.locked,
          .threads = tracedThreads(),
          .degraded = std::move(degraded),
          .start = rt::now()};
}

SummaryRecord summaryRecord(const Status& status) {
  return {.clean_stop = true,
          .stop = rt::now(),
          .cpu_seconds = cpuSeconds(),
          .memory_bytes = residentBytes(),
          .frames_lost = status.frames_lost,
          .frames_away = status.frames_away,
          .frames_incomplete = status.frames_incomplete,
          .frames_unattributed = status.frames_unattributed,
          .pictures_skipped = status.pictures_skipped};
}

}  // namespace appliance
