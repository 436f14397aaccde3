#include <nlohmann/json.hpp>

#include "appliance/tools/report_text.h"

namespace appliance {
namespace {

using nlohmann::ordered_json;

ordered_json toObject(const Distribution& values) {
  const auto figure = [&](double value) {
    return values.count > 0 ? ordered_json(value) : ordered_json(nullptr);
  };
  return {{"count", values.count},     {"mean", figure(values.mean)}, {"sd", figure(values.sd)},
          {"p50", figure(values.p50)}, {"p99", figure(values.p99)},   {"p999", figure(values.p999)},
          {"max", figure(values.max)}};
}

ordered_json toObject(const FrameCounts& counts) {
  return {{"seconds", counts.seconds},
          {"triggers", counts.triggers},
          {"frames_expected", counts.frames_expected},
          {"frames_received", counts.frames_received},
          {"frames_lost", counts.frames_lost},
          {"frames_incomplete", counts.frames_incomplete},
          {"frames_unattributed", counts.frames_unattributed},
          {"frames_lost_in_stalls", counts.frames_lost_in_stalls},
          {"frames_incomplete_in_stalls", counts.frames_incomplete_in_stalls}};
}

ordered_json toObject(const StageTimes& stages) {
  return {{"trigger_edge_to_frame_ready", toObject(stages.trigger_edge_to_frame_ready)},
          {"last_packet_to_commit", toObject(stages.last_packet_to_commit)},
          {"target_point", toObject(stages.target_point)},
          {"homographies", toObject(stages.homographies)},
          {"demosaic_upload", toObject(stages.demosaic_upload)},
          {"warp", toObject(stages.warp)},
          {"commit_to_flip", toObject(stages.commit_to_flip)},
          {"trigger_edge_to_page_flip", toObject(stages.trigger_edge_to_page_flip)}};
}

template <class T>
ordered_json orNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json modesOf(const Report& report) {
  ordered_json modes = ordered_json::object();
  for (std::size_t i = 0; i < report.by_mode.size(); ++i) {
    const ModeTimes& times = report.by_mode[i];
    modes[std::string(nameOf(static_cast<Mode>(i)))] = {
        {"pictures", times.pictures},
        {"wake_to_commit_ms", toObject(times.wake_to_commit_ms)},
        {"trigger_edge_to_commit_ms", toObject(times.trigger_edge_to_commit_ms)}};
  }
  return modes;
}

ordered_json toObject(const GenlockReport& genlock) {
  ordered_json unlocks = ordered_json::array();
  for (const auto& unlock : genlock.unlocks)
    unlocks.push_back({{"trigger", unlock.trigger}, {"reason", nameOf(unlock.reason)}});
  ordered_json histogram = ordered_json::object();
  for (const auto& [vblanks, pictures] : genlock.trigger_to_flip_vblanks)
    histogram[std::to_string(vblanks)] = pictures;
  const bool any = !genlock.trigger_to_flip_vblanks.empty();
  const auto end = [&](auto vblanks) {
    return any ? ordered_json(vblanks()) : ordered_json(nullptr);
  };
  return {{"state", genlock.state ? ordered_json(nameOf(*genlock.state)) : ordered_json(nullptr)},
          {"reason", nameOf(genlock.reason)},
          {"vblanks_per_trigger", genlock.vblanks_per_trigger},
          {"locked_after_s", orNull(genlock.locked_after_s)},
          {"locked_share", genlock.locked_share},
          {"phase_error_us", toObject(genlock.phase_error_us)},
          {"lead_ms", toObject(genlock.lead_ms)},
          {"unlocks", std::move(unlocks)},
          {"trigger_to_flip_vblanks",
           {{"histogram", std::move(histogram)},
            {"min", end([&] { return genlock.trigger_to_flip_vblanks.begin()->first; })},
            {"max", end([&] { return genlock.trigger_to_flip_vblanks.rbegin()->first; })}}},
          {"trigger_edge_to_page_flip_ms",
           {{"locked", toObject(genlock.edge_to_flip_locked_ms)},
            {"free_running", toObject(genlock.edge_to_flip_free_ms)}}}};
}

ordered_json barsOf(const Report& report) {
  ordered_json bars = ordered_json::array();
  for (const Bar& bar : report.bars) {
    bars.push_back({{"what", bar.what},
                    {"value", orNull(bar.value)},
                    {bar.at_least ? "at_least" : "at_most", bar.limit},
                    {"passed", orNull(bar.passed())}});
  }
  return bars;
}

ordered_json threadsOf(const RunRecord& run) {
  ordered_json threads = ordered_json::array();
  for (const TracedThread& thread : run.threads) {
    threads.push_back({{"name", thread.name},
                       {"policy", thread.policy},
                       {"priority", thread.priority},
                       {"cpu", thread.cpu},
                       {"as_asked", thread.as_asked}});
  }
  return threads;
}

}  // namespace

std::string toJson(const Report& report) {
  const RunRecord& run = report.run;
  ordered_json object = {{"version", run.version},
                         {"cameras", run.cameras},
                         {"width", run.width_px},
                         {"height", run.height_px},
                         {"pixel_format", run.pixel_format},
                         {"trigger_hz", run.trigger_hz}};
  object.update(toObject(report.whole));
  ordered_json after = toObject(report.after_warm_up);
  after["warm_up_s"] = report.warm_up_s;
  object.update(
      ordered_json{{"after_warm_up", std::move(after)},
                   {"stalls",
                    {{"count", report.stalls.count},
                     {"longest_ms", report.stalls.longest_ms},
                     {"total_ms", report.stalls.total_ms}}},
                   {"valid", report.valid},
                   {"invalid_reasons", report.invalid_reasons},
                   {"frames_misattributed", orNull(report.frames_misattributed)},
                   {"shown_fps", report.shown_fps},
                   {"pictures", report.pictures},
                   {"pictures_repeated", report.pictures_repeated},
                   {"pictures_imported", report.pictures_imported},
                   {"trigger_lateness_us", toObject(report.trigger_lateness_us)},
                   {"trigger_edge_delay_us", toObject(report.trigger_edge_delay_us)},
                   {"button_to_commit_ms", toObject(report.button_to_commit_ms)},
                   {"stages_ms", toObject(report.stages_ms)},
                   {"last_packet_from", report.last_packet_from_wire_log ? "wire log" : "trace"},
                   {"by_mode", modesOf(report)},
                   {"genlock", toObject(report.genlock)},
                   {"cpu_seconds",
                    {{"kagamid", report.cpu_seconds_kagamid},
                     {"emulator", orNull(report.cpu_seconds_emulator)}}},
                   {"memory_bytes", report.memory_bytes},
                   {"history_sets", run.history_sets},
                   {"history_bytes", run.memory_bytes},
                   {"memory_locked", run.memory_locked},
                   {"renderer", run.renderer},
                   {"source_path", run.source_path},
                   {"display",
                    {{"width", run.display_width_px},
                     {"height", run.display_height_px},
                     {"refresh_hz", run.refresh_hz}}},
                   {"threads", threadsOf(run)},
                   {"degraded", run.degraded},
                   {"bars", barsOf(report)}});
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace appliance
