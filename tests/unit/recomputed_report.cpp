#include "tests/unit/recomputed_report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace {

using nlohmann::json;
using Lines = std::vector<json>;

json spread(std::vector<double> values) {
  json out = {{"count", values.size()}};
  if (values.empty()) {
    for (const char* name : {"mean", "sd", "p50", "p99", "p999", "max"}) out[name] = nullptr;
    return out;
  }
  std::sort(values.begin(), values.end());
  // Welford, so that not even the way of summing is shared.
  long double mean = 0;
  long double squares = 0;
  long double n = 0;
  for (const double value : values) {
    n += 1;
    const long double step = value - mean;
    mean += step / n;
    squares += step * (value - mean);
  }
  const auto percentile = [&](double share) {
    std::size_t i = 0;
    while (static_cast<double>(i + 1) < share * static_cast<double>(values.size())) ++i;
    return values[i];
  };
  out["mean"] = static_cast<double>(mean);
  out["sd"] = n > 1 ? static_cast<double>(std::sqrt(squares / (n - 1))) : 0.0;
  out["p50"] = percentile(0.5);
  out["p99"] = percentile(0.99);
  out["p999"] = percentile(0.999);
  out["max"] = values.back();
  return out;
}

std::int64_t ns(const json& line, const std::string& instant) {
  return line.at(instant + "_ns").get<std::int64_t>();
}

/// begin to end in ms of every line that has both.
std::vector<double> between(const Lines& lines, const std::string& begin, const std::string& end) {
  std::vector<double> values;
  for (const json& line : lines)
    if (ns(line, begin) != 0 && ns(line, end) != 0)
      values.push_back(static_cast<double>(ns(line, end) - ns(line, begin)) * 1e-6);
  return values;
}

struct Run {
  json head;
  json summary;
  std::map<std::string, Lines> lines;
  std::map<std::int64_t, std::int64_t> edge;  // trigger -> trigger_edge_before_ns
  std::map<std::int64_t, std::int64_t> flip;  // picture -> page_flip_ns
};

Run readRun(std::istream& in) {
  Run run;
  for (std::string text; std::getline(in, text);) {
    const json line = json::parse(text);
    const auto kind = line.at("record").get<std::string>();
    if (kind == "run") run.head = line;
    if (kind == "summary") run.summary = line;
    run.lines[kind].push_back(line);
  }
  for (const json& line : run.lines["trigger"])
    run.edge[line["trigger"].get<std::int64_t>()] = ns(line, "trigger_edge_before");
  for (const json& line : run.lines["flip"])
    run.flip.emplace(line["picture_id"].get<std::int64_t>(), ns(line, "page_flip"));
  return run;
}

struct Sent {
  std::int64_t edge_ns, first_packet_ns, last_packet_ns;
};
using Wire = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<Sent>>;

Wire readWire(std::istream& in) {
  Wire wire;
  std::string text;
  std::getline(in, text);
  while (std::getline(in, text)) {
    std::ranges::replace(text, ',', ' ');
    std::istringstream fields(text);
    std::int64_t camera = 0, frame_id = 0, trigger = 0, exposure_end_ns = 0;
    Sent sent{};
    fields >> camera >> frame_id >> trigger >> sent.edge_ns >> exposure_end_ns >>
        sent.first_packet_ns >> sent.last_packet_ns;
    wire[{camera, frame_id}].push_back(sent);
  }
  return wire;
}

const Sent* sentOf(const Wire& wire, const json& frame) {
  std::int64_t frame_id = frame["frame_id"].get<std::int64_t>();
  while (frame_id > 65535) frame_id -= 65535;
  const auto found = wire.find({frame["camera"].get<std::int64_t>(), frame_id});
  if (found == wire.end()) return nullptr;
  const Sent* best = nullptr;
  for (const Sent& sent : found->second)
    if (sent.first_packet_ns <= ns(frame, "frame_ready")) best = &sent;
  return best;
}

/// Whether any one probe saw a stall around the instant. Stalls are not joined here.
bool stoodStill(const Run& run, std::int64_t at_ns) {
  const auto stalls = run.lines.find("stall");
  if (stalls == run.lines.end()) return false;
  const auto period_ns =
      static_cast<std::int64_t>(std::llround(1e9 / run.head["trigger_hz"].get<double>()));
  return std::ranges::any_of(stalls->second, [&](const json& stall) {
    return at_ns >= ns(stall, "begin") - 2 * period_ns && at_ns <= ns(stall, "end") + period_ns;
  });
}

/// Sweeps over the begins and ends: the machine stands still while any probe says so.
json stallsOf(const Run& run) {
  std::vector<std::pair<std::int64_t, int>> ends;
  if (const auto stalls = run.lines.find("stall"); stalls != run.lines.end()) {
    for (const json& stall : stalls->second) {
      ends.emplace_back(ns(stall, "begin"), -1);  // before an end at the same instant
      ends.emplace_back(ns(stall, "end"), 1);
    }
  }
  std::ranges::sort(ends);
  int open = 0;
  std::int64_t count = 0, begin_ns = 0, longest_ns = 0, total_ns = 0;
  for (const auto& [at_ns, step] : ends) {
    if (open == 0) {
      ++count;
      begin_ns = at_ns;
    }
    open -= step;
    if (open > 0) continue;
    total_ns += at_ns - begin_ns;
    longest_ns = std::max(longest_ns, at_ns - begin_ns);
  }
  return {{"count", count},
          {"longest_ms", static_cast<double>(longest_ns) * 1e-6},
          {"total_ms", static_cast<double>(total_ns) * 1e-6}};
}

json countsFrom(const Run& run, std::int64_t from_ns) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::set<std::string>> seen;
  std::int64_t incomplete = 0;
  std::int64_t unattributed = 0;
  std::int64_t incomplete_in_stalls = 0;
  const auto frames = run.lines.find("frame");
  for (const json& frame : frames == run.lines.end() ? Lines{} : frames->second) {
    const auto trigger = frame["trigger"].get<std::int64_t>();
    const auto edge = run.edge.find(trigger);
    const bool in = trigger == 0 ? ns(frame, "first_packet") >= from_ns
                                 : edge != run.edge.end() && edge->second >= from_ns;
    const auto status = frame["status"].get<std::string>();
    if (!in || status == "aborted") continue;
    if (status != "complete") ++incomplete;
    if (status != "complete" && stoodStill(run, ns(frame, "first_packet"))) ++incomplete_in_stalls;
    if (trigger != 0)
      seen[{frame["camera"].get<std::int64_t>(), trigger}].insert(status);
    else if (status == "complete")
      ++unattributed;
  }
  std::int64_t triggers = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::int64_t lost_in_stalls = 0;
  for (const auto& [trigger, edge_ns] : run.edge) {
    if (edge_ns < from_ns) continue;
    for (std::int64_t camera = 0; camera < run.head["cameras"].get<std::int64_t>(); ++camera)
      if (!seen.contains({camera, trigger}) && stoodStill(run, edge_ns)) ++lost_in_stalls;
    if (triggers++ == 0) first_ns = edge_ns;
    last_ns = edge_ns;
  }
  const auto received = std::ranges::count_if(
      seen, [](const auto& entry) { return entry.second.contains("complete"); });
  const std::int64_t expected = triggers * run.head["cameras"].get<std::int64_t>();
  return {{"triggers", triggers},
          {"seconds", triggers == 0 ? 0.0
                                    : static_cast<double>(last_ns - first_ns) * 1e-9 +
                                          1 / run.head["trigger_hz"].get<double>()},
          {"frames_expected", expected},
          {"frames_received", received},
          {"frames_incomplete", incomplete},
          {"frames_lost", expected - static_cast<std::int64_t>(seen.size())},
          {"frames_unattributed", unattributed},
          {"frames_lost_in_stalls", lost_in_stalls},
          {"frames_incomplete_in_stalls", incomplete_in_stalls}};
}

}  // namespace

json recomputedReport(std::istream& trace, std::istream* wire_log, double warm_up_s) {
  Run run = readRun(trace);
  const Wire wire = wire_log != nullptr ? readWire(*wire_log) : Wire{};
  json out = countsFrom(run, 0);
  out["stalls"] = stallsOf(run);
  const std::int64_t begin_ns = run.edge.empty() ? 0 : run.edge.begin()->second;
  out["after_warm_up"] = countsFrom(run, begin_ns + std::llround(warm_up_s * 1e9));

  std::map<std::pair<std::int64_t, std::int64_t>, json> received;
  for (const json& frame : run.lines["frame"])
    if (frame["status"] == "complete" && frame["trigger"] != 0)
      received.emplace(
          std::pair(frame["camera"].get<std::int64_t>(), frame["trigger"].get<std::int64_t>()),
          frame);
  std::vector<double> ready;
  std::int64_t misattributed = 0;
  for (const auto& [key, frame] : received) {
    ready.push_back(static_cast<double>(ns(frame, "frame_ready") - run.edge.at(key.second)) * 1e-6);
    const Sent* sent = sentOf(wire, frame);
    const double half_period_ns = 0.5e9 / run.head["trigger_hz"].get<double>();
    if (sent != nullptr &&
        std::abs(static_cast<double>(sent->edge_ns - run.edge.at(key.second))) > half_period_ns)
      ++misattributed;
  }
  out["frames_misattributed"] = wire_log != nullptr ? json(misattributed) : json(nullptr);

  Lines pictures;
  for (const json& picture : run.lines["picture"])
    if (ns(picture, "commit") != 0 && picture["trigger"] != 0) pictures.push_back(picture);
  std::sort(pictures.begin(), pictures.end(), [](const json& one, const json& other) {
    return std::pair(ns(one, "commit"), one["picture_id"]) <
           std::pair(ns(other, "commit"), other["picture_id"]);
  });

  // One pass over neighbours: every stretch between two commits belongs to the mode of the first.
  double playing_s = 0;
  std::set<std::tuple<int, std::int64_t>> sets;  // phase, trigger
  std::int64_t repeated = 0;
  int phase = 0;
  std::vector<double> to_commit, to_flip, flips, locked_flips, free_flips;
  std::map<std::int64_t, json> genlock;  // by the first trigger it holds for
  std::vector<double> phase_error_us, leads;
  json unlocks = json::array();
  for (const json& said : run.lines["genlock"]) {
    const auto last = genlock.empty() ? 0 : genlock.rbegin()->second["unlocks"].get<int>();
    if (said["unlocks"].get<int>() != last)
      unlocks.push_back({{"trigger", said["trigger"]}, {"reason", said["reason"]}});
    genlock[said["trigger"].get<std::int64_t>()] = said;
    if (said["state"] != "locked") continue;
    phase_error_us.push_back(std::abs(static_cast<double>(ns(said, "phase_error"))) * 1e-3);
    leads.push_back(static_cast<double>(ns(said, "lead")) * 1e-6);
  }
  const auto genlockOf = [&](std::int64_t trigger) -> const json* {
    const json* holds = nullptr;
    for (const auto& [from, said] : genlock)
      if (from <= trigger) holds = &said;
    return holds;
  };
  std::map<std::string, int> vblank_counts;
  std::set<int> vblanks_seen;
  std::map<std::string, std::vector<double>> edge_to_commit;
  std::map<std::string, Lines> of_mode;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const json& now = pictures[i];
    const auto mode = now["mode"].get<std::string>();
    const auto trigger = now["trigger"].get<std::int64_t>();
    const bool playing = mode == "live" || mode == "delayed";
    const json* before = i > 0 ? &pictures[i - 1] : nullptr;
    const bool pressed_back =
        before != nullptr && now["button_event_ns"] != 0 && now["trigger"] < (*before)["trigger"];
    if (before != nullptr && ((*before)["mode"] != now["mode"] || pressed_back)) ++phase;
    if (playing && i + 1 < pictures.size()) {
      playing_s += static_cast<double>(ns(pictures[i + 1], "commit") - ns(now, "commit")) * 1e-9;
      sets.emplace(phase, trigger);
    }
    if (playing && before != nullptr && (*before)["mode"] == now["mode"] &&
        (*before)["trigger"] == now["trigger"] && (*before)["camera_shown"] == now["camera_shown"])
      ++repeated;
    of_mode[mode].push_back(now);
    const auto flip = run.flip.find(now["picture_id"].get<std::int64_t>());
    if (flip != run.flip.end())
      flips.push_back(static_cast<double>(flip->second - ns(now, "commit")) * 1e-6);
    if (before != nullptr && (*before)["trigger"] == now["trigger"]) continue;
    if (const auto edge = run.edge.find(trigger); edge != run.edge.end()) {
      edge_to_commit[mode].push_back(static_cast<double>(ns(now, "commit") - edge->second) * 1e-6);
      if (mode == "live" && flip != run.flip.end()) {
        to_flip.push_back(static_cast<double>(flip->second - edge->second) * 1e-6);
        const json* said = genlockOf(trigger);
        if (said == nullptr || (*said)["state"] != "locked") {
          free_flips.push_back(to_flip.back());
        } else {
          locked_flips.push_back(to_flip.back());
          const double vblank_ms = static_cast<double>(ns(*said, "vblank_period")) * 1e-6;
          const double lead_ms = static_cast<double>(ns(*said, "lead")) * 1e-6;
          const int meant =
              static_cast<int>(std::ceil(spread(leads)["p50"].get<double>() / vblank_ms));
          const int late =
              static_cast<int>(std::floor((to_flip.back() - lead_ms) / vblank_ms + 0.5));
          ++vblank_counts[std::to_string(meant + late)];
          vblanks_seen.insert(meant + late);
        }
      }
    }
    const auto frame = received.find({now["camera_shown"].get<std::int64_t>(), trigger});
    if (mode != "live" || frame == received.end()) continue;
    const Sent* sent = sentOf(wire, frame->second);
    if (wire_log != nullptr && sent == nullptr) continue;
    const std::int64_t last_ns =
        wire_log != nullptr ? sent->last_packet_ns : ns(frame->second, "last_packet");
    to_commit.push_back(static_cast<double>(ns(now, "commit") - last_ns) * 1e-6);
  }
  std::int64_t locked_triggers = 0;
  json locked_after = nullptr;
  for (const auto& [trigger, edge_ns] : run.edge) {
    const json* said = genlockOf(trigger);
    if (said == nullptr || (*said)["state"] != "locked") continue;
    if (locked_triggers++ == 0) locked_after = static_cast<double>(edge_ns - begin_ns) * 1e-9;
  }
  const json* last = genlockOf(std::numeric_limits<std::int64_t>::max());
  out["genlock"] = {
      {"state", last != nullptr ? (*last)["state"] : json(nullptr)},
      {"reason", last != nullptr ? (*last)["reason"] : json("none")},
      {"vblanks_per_trigger", last != nullptr ? (*last)["vblanks_per_trigger"] : json(0)},
      {"locked_after_s", locked_after},
      {"locked_share", run.edge.empty() ? 0.0
                                        : static_cast<double>(locked_triggers) /
                                              static_cast<double>(run.edge.size())},
      {"phase_error_us", spread(phase_error_us)},
      {"lead_ms", spread(leads)},
      {"unlocks", unlocks},
      {"trigger_to_flip_vblanks",
       {{"histogram", vblank_counts},
        {"min", vblanks_seen.empty() ? json(nullptr) : json(*vblanks_seen.begin())},
        {"max", vblanks_seen.empty() ? json(nullptr) : json(*vblanks_seen.rbegin())}}},
      {"trigger_edge_to_page_flip_ms",
       {{"locked", spread(locked_flips)}, {"free_running", spread(free_flips)}}}};
  out["pictures"] = pictures.size();
  out["pictures_repeated"] = repeated;
  out["pictures_imported"] = std::ranges::count_if(
      pictures, [](const json& picture) { return picture["imported"] == true; });
  out["shown_fps"] = playing_s > 0 ? static_cast<double>(sets.size()) / playing_s : 0.0;
  auto lateness = between(run.lines["trigger"], "deadline", "trigger_edge_after");
  for (double& value : lateness) value *= 1e3;
  out["trigger_lateness_us"] = spread(lateness);
  std::vector<double> edge_delay;
  for (const json& seen : run.lines["loopback"])
    if (const auto edge = run.edge.find(seen["trigger"].get<std::int64_t>());
        edge != run.edge.end())
      edge_delay.push_back(static_cast<double>(ns(seen, "edge") - edge->second) * 1e-3);
  out["trigger_edge_delay_us"] = spread(edge_delay);
  out["button_to_commit_ms"] = spread(between(pictures, "button_event", "commit"));
  out["stages_ms"] = {
      {"trigger_edge_to_frame_ready", spread(ready)},
      {"last_packet_to_commit", spread(to_commit)},
      {"target_point", spread(between(pictures, "target_point_begin", "target_point_end"))},
      {"homographies", spread(between(pictures, "homographies_begin", "homographies_end"))},
      {"demosaic_upload", spread(between(pictures, "warp_submit", "upload_end"))},
      {"warp", spread(between(pictures, "upload_end", "warp_end"))},
      {"commit_to_flip", spread(flips)},
      {"trigger_edge_to_page_flip", spread(to_flip)}};
  for (const char* mode : {"live", "delayed", "frozen", "sweep", "slow"})
    out["by_mode"][mode] = {{"pictures", of_mode[mode].size()},
                            {"wake_to_commit_ms", spread(between(of_mode[mode], "wake", "commit"))},
                            {"trigger_edge_to_commit_ms", spread(edge_to_commit[mode])}};
  for (const char* name : {"cameras", "trigger_hz", "renderer", "source_path"})
    out[name] = run.head[name];
  out["width"] = run.head["width_px"];
  out["height"] = run.head["height_px"];
  out["cpu_seconds"]["kagamid"] = run.summary["cpu_seconds"];
  out["memory_bytes"] = run.summary["memory_bytes"];
  return out;
}

void expectSameFigures(const json& report, const json& recomputed) {
  const json flat = report.flatten();
  const json figures = recomputed.flatten();
  for (const auto& [path, expected] : figures.items()) {
    ASSERT_TRUE(flat.contains(path)) << path << " is missing in the report";
    const json& figure = flat[path];
    if (expected.is_number() && figure.is_number())
      EXPECT_NEAR(figure.get<double>(), expected.get<double>(),
                  1e-9 * std::max(1.0, std::abs(expected.get<double>())))
          << path;
    else
      EXPECT_EQ(figure, expected) << path;
  }
}
