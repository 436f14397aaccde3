#include "appliance/tools/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "appliance/tools/stall_periods.h"

namespace appliance {
namespace {

using CameraTrigger = std::pair<std::uint32_t, std::uint64_t>;

double ms(rt::Timestamp from, rt::Timestamp to) {
  return static_cast<double>((to - from).count()) / 1e6;
}
double us(rt::Timestamp from, rt::Timestamp to) {
  return ms(from, to) * 1e3;
}
bool happened(rt::Timestamp t) {
  return t != rt::Timestamp{};
}

/// Appends the time between two instants that both happened.
void append(std::vector<double>& values, rt::Timestamp from, rt::Timestamp to) {
  if (happened(from) && happened(to)) values.push_back(ms(from, to));
}

/// Everything the report looks up by number.
struct Index {
  explicit Index(const Trace& trace) {
    for (const TriggerRecord& trigger : trace.triggers) triggers.emplace(trigger.trigger, &trigger);
    for (const FrameRecord& frame : trace.frames)
      if (frame.trigger != 0 && frame.status == hal::FrameStatus::kComplete)
        complete.emplace(CameraTrigger(frame.camera, frame.trigger), &frame);
    for (const FlipRecord& flip : trace.flips) flips.emplace(flip.picture_id, flip.page_flip);
  }

  /// The earliest instant at which the edge can have left: latencies are not flattered.
  [[nodiscard]] rt::Timestamp triggerEdge(std::uint64_t trigger) const {
    const auto found = triggers.find(trigger);
    return found == triggers.end() ? rt::Timestamp{} : found->second->trigger_edge_before;
  }

  std::unordered_map<std::uint64_t, const TriggerRecord*> triggers;
  std::map<CameraTrigger, const FrameRecord*> complete;
  std::unordered_map<std::uint64_t, rt::Timestamp> flips;
};

/// The emulator's frames by what identifies them on the wire.
class WireIndex {
 public:
  explicit WireIndex(const std::vector<SentFrame>& log) {
    for (const SentFrame& frame : log)
      frames_[{frame.camera, onWire(frame.frame_id)}].push_back(&frame);
  }

  /// Ids come again after a wrap and after a camera's restart: the frame is the last one of its
  /// id that had begun to be sent when it was ready.
  [[nodiscard]] const SentFrame* find(const FrameRecord& frame) const {
    const auto found = frames_.find({frame.camera, onWire(frame.frame_id)});
    if (found == frames_.end()) return nullptr;
    const SentFrame* latest = nullptr;
    for (const SentFrame* sent : found->second)
      if (sent->first_packet <= frame.frame_ready) latest = sent;
    return latest;
  }

 private:
  static std::uint64_t onWire(std::uint64_t frame_id) {
    constexpr std::uint64_t kLastId = 65535;  // then 1 again: GigE Vision's 16-bit block ids
    return frame_id == 0 ? 0 : (frame_id - 1) % kLastId + 1;
  }

  std::map<CameraTrigger, std::vector<const SentFrame*>> frames_;
};

/// The frames that did not arrive of triggers that a stall may have cost.
std::uint64_t lostInStalls(std::uint32_t cameras,
                           const std::map<std::uint64_t, rt::Timestamp>& edges,
                           const std::set<CameraTrigger>& arrived, const StallPeriods& stalls) {
  std::uint64_t lost = 0;
  for (const auto& [trigger, edge] : edges) {
    if (!stalls.mayHaveCost(edge)) continue;
    for (std::uint32_t camera = 0; camera < cameras; ++camera)
      if (!arrived.contains({camera, trigger})) ++lost;
  }
  return lost;
}

FrameCounts countFrames(const Trace& trace, rt::Timestamp from, const StallPeriods& stalls) {
  FrameCounts counts;
  std::map<std::uint64_t, rt::Timestamp> triggers;  // and their edges
  rt::Timestamp first;
  rt::Timestamp last;
  for (const TriggerRecord& trigger : trace.triggers) {
    if (trigger.trigger_edge_before < from) continue;
    if (triggers.empty()) first = trigger.trigger_edge_before;
    last = trigger.trigger_edge_before;
    triggers.emplace(trigger.trigger, trigger.trigger_edge_before);
  }
  counts.triggers = triggers.size();
  counts.frames_expected = counts.triggers * trace.run.cameras;
  if (!triggers.empty() && trace.run.trigger_hz > 0)
    counts.seconds = ms(first, last) / 1e3 + 1 / trace.run.trigger_hz;

  std::set<CameraTrigger> received;
  std::set<CameraTrigger> arrived;
  for (const FrameRecord& frame : trace.frames) {
    const bool counted =
        frame.trigger != 0 ? triggers.contains(frame.trigger) : frame.first_packet >= from;
    if (!counted) continue;
    const CameraTrigger key(frame.camera, frame.trigger);
    if (frame.status == hal::FrameStatus::kComplete) {
      if (frame.trigger == 0)
        ++counts.frames_unattributed;
      else if (received.insert(key).second)
        arrived.insert(key);
    } else if (frame.status != hal::FrameStatus::kAborted) {
      ++counts.frames_incomplete;
      if (stalls.mayHaveCost(frame.first_packet)) ++counts.frames_incomplete_in_stalls;
      if (frame.trigger != 0) arrived.insert(key);
    }
  }
  counts.frames_received = received.size();
  counts.frames_lost =
      counts.frames_expected - std::min<std::uint64_t>(counts.frames_expected, arrived.size());
  counts.frames_lost_in_stalls =
      std::min(counts.frames_lost, lostInStalls(trace.run.cameras, triggers, arrived, stalls));
  return counts;
}

/// The pictures that count: committed and not empty, in the order of their commits.
std::vector<const PictureRecord*> shownPictures(const Trace& trace) {
  std::vector<const PictureRecord*> shown;
  for (const PictureRecord& picture : trace.pictures)
    if (happened(picture.commit) && picture.trigger != 0) shown.push_back(&picture);
  std::ranges::sort(shown, {}, [](const PictureRecord* picture) {
    return std::pair(picture->commit, picture->picture_id);
  });
  return shown;
}

bool playing(Mode mode) {
  return mode == Mode::kLive || mode == Mode::kDelayed;
}

bool sameFrame(const PictureRecord& a, const PictureRecord& b) {
  return a.trigger == b.trigger && a.camera_shown == b.camera_shown;
}

/// A press that goes back in time shows stored moments again: that is a new phase, not a repeat.
bool samePhase(const PictureRecord& before, const PictureRecord& now) {
  const bool back = now.button_event != rt::Timestamp{} && now.trigger < before.trigger;
  return before.mode == now.mode && !back;
}

/// A phase lasts from its first commit to the next phase's first; the last one to its last
/// commit, whose picture then does not count: it has no duration yet.
double distinctSetsPerSecond(const std::vector<const PictureRecord*>& shown) {
  std::size_t sets = 0;
  double seconds = 0;
  for (std::size_t begin = 0, end = 0; begin < shown.size(); begin = end) {
    end = begin + 1;
    while (end < shown.size() && samePhase(*shown[end - 1], *shown[end])) ++end;
    if (!playing(shown[begin]->mode)) continue;
    const std::size_t closing = end < shown.size() ? end : end - 1;
    std::set<std::uint64_t> distinct;
    for (std::size_t i = begin; i < closing; ++i) distinct.insert(shown[i]->trigger);
    sets += distinct.size();
    seconds += ms(shown[begin]->commit, shown[closing]->commit) / 1e3;
  }
  return seconds > 0 ? static_cast<double>(sets) / seconds : 0;
}

/// All values that the pictures and frames give, before they become distributions.
struct Values {
  std::vector<double> edge_to_ready, last_packet_to_commit, target_point, homographies,
      demosaic_upload, warp, commit_to_flip, button_to_commit, lateness_us, edge_delay_us;
  std::array<std::vector<double>, kModes.size()> wake_to_commit, edge_to_commit;
  std::vector<FlippedTrigger> flipped;
};

void addNewFrame(const PictureRecord& picture, const Index& index, const WireIndex* wire,
                 Values& values) {
  const rt::Timestamp edge = index.triggerEdge(picture.trigger);
  append(values.edge_to_commit[static_cast<std::size_t>(picture.mode)], edge, picture.commit);
  if (picture.mode != Mode::kLive) return;
  if (const auto flip = index.flips.find(picture.picture_id);
      flip != index.flips.end() && happened(edge) && happened(flip->second))
    values.flipped.push_back({picture.trigger, ms(edge, flip->second)});
  const auto frame = index.complete.find({picture.camera_shown, picture.trigger});
  if (frame == index.complete.end()) return;
  if (wire == nullptr)
    append(values.last_packet_to_commit, frame->second->last_packet, picture.commit);
  else if (const SentFrame* sent = wire->find(*frame->second))
    append(values.last_packet_to_commit, sent->last_packet, picture.commit);
}

void addPictures(const std::vector<const PictureRecord*>& shown, const Index& index,
                 const WireIndex* wire, Values& values) {
  const PictureRecord* before = nullptr;
  for (const PictureRecord* picture : shown) {
    append(values.target_point, picture->target_point_begin, picture->target_point_end);
    append(values.homographies, picture->homographies_begin, picture->homographies_end);
    append(values.demosaic_upload, picture->warp_submit, picture->upload_end);
    append(values.warp, picture->upload_end, picture->warp_end);
    append(values.button_to_commit, picture->button_event, picture->commit);
    append(values.wake_to_commit[static_cast<std::size_t>(picture->mode)], picture->wake,
           picture->commit);
    if (const auto flip = index.flips.find(picture->picture_id); flip != index.flips.end())
      append(values.commit_to_flip, picture->commit, flip->second);
    // Another view of the same moment is no new frame set: its age says nothing of the pipeline.
    if (before == nullptr || before->trigger != picture->trigger)
      addNewFrame(*picture, index, wire, values);
    before = picture;
  }
}

std::uint64_t countMisattributed(const Index& index, const WireIndex& wire, double trigger_hz) {
  const double half_period_ms = trigger_hz > 0 ? 500 / trigger_hz : 0;
  return static_cast<std::uint64_t>(std::ranges::count_if(index.complete, [&](const auto& entry) {
    const SentFrame* sent = wire.find(*entry.second);
    const rt::Timestamp edge = index.triggerEdge(entry.second->trigger);
    return sent != nullptr && std::abs(ms(edge, sent->trigger_edge)) > half_period_ms;
  }));
}

std::vector<std::string> whyInvalid(const ReportInput& input, const Report& report) {
  std::vector<std::string> reasons;
  const auto& summary = input.trace.summary;
  if (!summary)
    reasons.emplace_back("the trace is incomplete: kagamid did not shut down cleanly");
  else if (!summary->clean_stop)
    reasons.emplace_back("kagamid did not stop cleanly");
  if (summary && summary->trace_dropped > 0)
    reasons.push_back("the trace lost " + std::to_string(summary->trace_dropped) + " records");
  if (report.whole.triggers == 0) reasons.emplace_back("no trigger was fired");
  if (report.pictures == 0) reasons.emplace_back("no picture was shown");
  if (input.emulator != nullptr && !input.emulator->valid)
    reasons.push_back("the emulator could not keep up: " + input.emulator->invalid_reason);
  if (report.frames_misattributed.value_or(0) > 0)
    reasons.push_back(std::to_string(*report.frames_misattributed) +
                      " frames were attributed to a wrong trigger");
  return reasons;
}

std::optional<double> measured(const Distribution& values, double Distribution::* which) {
  if (values.count == 0) return std::nullopt;
  return values.*which;
}

std::vector<Bar> barsOf(const Report& report) {
  constexpr double kShownShare = 0.95;  // 38 of 40 Hz
  const StageTimes& stages = report.stages_ms;
  const auto frames = [&](std::uint64_t count) -> std::optional<double> {
    if (report.after_warm_up.triggers == 0) return std::nullopt;
    return static_cast<double>(count);
  };
  const auto fps = report.shown_fps > 0 ? std::optional(report.shown_fps) : std::nullopt;
  return {
      {"valid", report.valid ? 1.0 : 0.0, true, 1},
      {"frames_lost after warm-up", frames(report.after_warm_up.lostByUs()), false, 0},
      {"frames_incomplete after warm-up", frames(report.after_warm_up.incompleteByUs()), false, 0},
      {"shown_fps", fps, true, kShownShare * report.run.trigger_hz},
      {"last_packet_to_commit p50, ms", measured(stages.last_packet_to_commit, &Distribution::p50),
       false, 12},
      {"last_packet_to_commit p99, ms", measured(stages.last_packet_to_commit, &Distribution::p99),
       false, 25},
      {"button_to_commit p99, ms", measured(report.button_to_commit_ms, &Distribution::p99), false,
       40},
      {"homographies mean, ms", measured(stages.homographies, &Distribution::mean), false, 0.010},
  };
}

rt::Timestamp warmUpEnd(const Trace& trace, double warm_up_s) {
  if (trace.triggers.empty()) return {};
  return trace.triggers.front().trigger_edge_before +
         rt::Nanoseconds(std::llround(warm_up_s * 1e9));
}

void countPictures(const std::vector<const PictureRecord*>& shown, Report& report) {
  report.pictures = shown.size();
  report.shown_fps = distinctSetsPerSecond(shown);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    ++report.by_mode[static_cast<std::size_t>(shown[i]->mode)].pictures;
    if (shown[i]->imported) ++report.pictures_imported;
    if (i > 0 && playing(shown[i]->mode) && shown[i]->mode == shown[i - 1]->mode &&
        sameFrame(*shown[i - 1], *shown[i]))
      ++report.pictures_repeated;
  }
}

}  // namespace

Report computeReport(const ReportInput& input) {
  const Trace& trace = input.trace;
  Report report;
  report.run = trace.run;
  report.warm_up_s = input.warm_up_s;
  const double period_ns = trace.run.trigger_hz > 0 ? 1e9 / trace.run.trigger_hz : 0;
  const StallPeriods stalls(trace.stalls, rt::Nanoseconds(std::llround(period_ns)));
  report.stalls = {.count = stalls.count(),
                   .longest_ms = static_cast<double>(stalls.longest().count()) / 1e6,
                   .total_ms = static_cast<double>(stalls.total().count()) / 1e6};
  report.whole = countFrames(trace, {}, stalls);
  report.after_warm_up = countFrames(trace, warmUpEnd(trace, input.warm_up_s), stalls);

  const Index index(trace);
  std::optional<WireIndex> wire;
  if (input.wire_log != nullptr) wire.emplace(*input.wire_log);
  report.last_packet_from_wire_log = wire.has_value();
  if (wire) report.frames_misattributed = countMisattributed(index, *wire, trace.run.trigger_hz);

  const auto shown = shownPictures(trace);
  countPictures(shown, report);

  Values values;
  for (const TriggerRecord& trigger : trace.triggers)
    values.lateness_us.push_back(us(trigger.deadline, trigger.trigger_edge_after));
  for (const LoopbackRecord& loopback : trace.loopbacks)
    if (const rt::Timestamp edge = index.triggerEdge(loopback.trigger); happened(edge))
      values.edge_delay_us.push_back(us(edge, loopback.edge));
  for (const auto& [key, frame] : index.complete)
    append(values.edge_to_ready, index.triggerEdge(frame->trigger), frame->frame_ready);
  addPictures(shown, index, wire ? &*wire : nullptr, values);

  std::vector<double> edge_to_flip;
  for (const FlippedTrigger& one : values.flipped) edge_to_flip.push_back(one.edge_to_flip_ms);
  report.trigger_lateness_us = distributionOf(std::move(values.lateness_us));
  report.trigger_edge_delay_us = distributionOf(std::move(values.edge_delay_us));
  report.button_to_commit_ms = distributionOf(std::move(values.button_to_commit));
  report.stages_ms = {
      .trigger_edge_to_frame_ready = distributionOf(std::move(values.edge_to_ready)),
      .last_packet_to_commit = distributionOf(std::move(values.last_packet_to_commit)),
      .target_point = distributionOf(std::move(values.target_point)),
      .homographies = distributionOf(std::move(values.homographies)),
      .demosaic_upload = distributionOf(std::move(values.demosaic_upload)),
      .warp = distributionOf(std::move(values.warp)),
      .commit_to_flip = distributionOf(std::move(values.commit_to_flip)),
      .trigger_edge_to_page_flip = distributionOf(std::move(edge_to_flip)),
  };
  report.genlock = computeGenlockReport(trace, values.flipped);
  for (std::size_t mode = 0; mode < report.by_mode.size(); ++mode) {
    report.by_mode[mode].wake_to_commit_ms = distributionOf(std::move(values.wake_to_commit[mode]));
    report.by_mode[mode].trigger_edge_to_commit_ms =
        distributionOf(std::move(values.edge_to_commit[mode]));
  }

  if (trace.summary) report.cpu_seconds_kagamid = trace.summary->cpu_seconds;
  report.memory_bytes = trace.summary ? trace.summary->memory_bytes : trace.run.memory_bytes;
  if (input.emulator != nullptr) report.cpu_seconds_emulator = input.emulator->cpu_seconds;
  report.invalid_reasons = whyInvalid(input, report);
  report.valid = report.invalid_reasons.empty();
  report.bars = barsOf(report);
  return report;
}

}  // namespace appliance
