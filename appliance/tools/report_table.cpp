#include <array>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>

#include "appliance/tools/report_text.h"

namespace appliance {
namespace {

/// One line of text by printf's rules; longer ones are cut.
[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
  std::array<char, 240> text{};
  va_list arguments;
  va_start(arguments, format);
  (void)std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

std::string row(const char* what, const Distribution& values, const char* laboratory) {
  if (values.count == 0) return line("  %-30s %39s   %s\n", what, "not measured", laboratory);
  return line("  %-30s %8.3f %7.3f %7.3f %7.3f %7.3f   %s\n", what, values.mean, values.sd,
              values.p50, values.p99, values.max, laboratory);
}

std::string heading(const Report& report) {
  const RunRecord& run = report.run;
  std::string text = line("%u cameras, %ux%u %s, %.6g Hz, %.1f s; picture %ux%u at %.6g Hz; %s\n",
                          run.cameras, run.width_px, run.height_px, run.pixel_format.c_str(),
                          run.trigger_hz, report.whole.seconds, run.display_width_px,
                          run.display_height_px, run.refresh_hz, run.renderer.c_str());
  const FrameCounts& after = report.after_warm_up;
  text += line("after %.3g s of warm-up: %" PRIu64 " frames expected, %" PRIu64
               " received, %" PRIu64 " lost, %" PRIu64 " incomplete\n",
               report.warm_up_s, after.frames_expected, after.frames_received, after.frames_lost,
               after.frames_incomplete);
  text += line("whole run:             %" PRIu64 " frames expected, %" PRIu64 " received, %" PRIu64
               " lost, %" PRIu64 " incomplete, %" PRIu64 " unattributed\n",
               report.whole.frames_expected, report.whole.frames_received, report.whole.frames_lost,
               report.whole.frames_incomplete, report.whole.frames_unattributed);
  if (report.stalls.count > 0)
    text += line("this PC stood still %" PRIu64
                 " times, for %.1f ms at most (firmware or host): %" PRIu64
                 " frames lost and %" PRIu64 " incomplete meanwhile, not judged\n",
                 report.stalls.count, report.stalls.longest_ms, after.frames_lost_in_stalls,
                 after.frames_incomplete_in_stalls);
  text += line("shown: %.2f frame sets a second; %" PRIu64 " pictures, %" PRIu64 " repeated\n",
               report.shown_fps, report.pictures, report.pictures_repeated);
  text += line("CPU: kagamid %.1f s", report.cpu_seconds_kagamid);
  if (report.cpu_seconds_emulator) text += line(", emulator %.1f s", *report.cpu_seconds_emulator);
  text += line("; memory %.2f GiB, frame history %.2f GiB (%u sets)%s\n",
               static_cast<double>(report.memory_bytes) / (1 << 30),
               static_cast<double>(run.memory_bytes) / (1 << 30), run.history_sets,
               run.memory_locked ? ", locked" : ", not locked");
  return text;
}

std::string stages(const Report& report) {
  const StageTimes& t = report.stages_ms;
  const auto& live = report.by_mode[static_cast<std::size_t>(Mode::kLive)];
  const auto& delayed = report.by_mode[static_cast<std::size_t>(Mode::kDelayed)];
  std::string text =
      "\nmilliseconds                        mean      sd     p50     p99     max"
      "   laboratory\n";
  text += row("trigger_edge_to_frame_ready", t.trigger_edge_to_frame_ready,
              "frame acquisition 19.4, sd 5.5");
  text += line("  %-30s %39s   %s\n", "(3D position)", "given, not tracked", "3D position 0.071");
  text += row("target_point", t.target_point, "target point 0.074");
  text += row("homographies", t.homographies, "");
  text += row("demosaic_upload", t.demosaic_upload, "");
  text += row("warp", t.warp, "output 0.037, on a GPU");
  text += row(report.last_packet_from_wire_log ? "last_packet_to_commit"
                                               : "last_packet_to_commit (as seen)",
              t.last_packet_to_commit, "");
  text += row("trigger edge to commit, live", live.trigger_edge_to_commit_ms, "total 19.6");
  text += row("wake to commit, delayed", delayed.wake_to_commit_ms, "delayed mode 5");
  text += row("commit_to_flip", t.commit_to_flip, "");
  text += row("trigger_edge_to_page_flip", t.trigger_edge_to_page_flip, "visible delay about 120");
  if (report.genlock.edge_to_flip_locked_ms.count > 0) {
    text += row("  while locked", report.genlock.edge_to_flip_locked_ms, "");
    text += row("  while free-running", report.genlock.edge_to_flip_free_ms, "");
  }
  text += row("button_to_commit", report.button_to_commit_ms, "");
  text += row("trigger lateness, us", report.trigger_lateness_us, "");
  text += row("trigger edge delay, us", report.trigger_edge_delay_us, "");
  text += row("genlock phase error, us", report.genlock.phase_error_us, "");
  return text;
}

std::string genlock(const GenlockReport& report) {
  if (!report.state) return {};
  std::string text = line("\ngenlock: %s", std::string(nameOf(*report.state)).c_str());
  if (report.reason != GenlockReason::kNone)
    text += line(" (%s)", std::string(nameOf(report.reason)).c_str());
  if (report.locked_after_s)
    text += line(", locked after %.2f s for %.1f %% of the triggers", *report.locked_after_s,
                 report.locked_share * 100);
  for (const auto& [vblanks, pictures] : report.trigger_to_flip_vblanks)
    text +=
        line("\n  %" PRIu64 " pictures %" PRId64 " vblanks after their trigger", pictures, vblanks);
  for (const auto& unlock : report.unlocks)
    text += line("\n  lock lost at trigger %" PRIu64 ": %s", unlock.trigger,
                 std::string(nameOf(unlock.reason)).c_str());
  return text + "\n";
}

std::string bars(const Report& report) {
  std::string text = "\n";
  for (const Bar& bar : report.bars) {
    const auto passed = bar.passed();
    const char* mark = !passed ? "----" : *passed ? "PASS" : "FAIL";
    const char* sign = bar.at_least ? ">=" : "<=";
    if (bar.value)
      text += line("  %s  %-34s %10.4g  (%s %.4g)\n", mark, bar.what.c_str(), *bar.value, sign,
                   bar.limit);
    else
      text += line("  %s  %-34s %10s  (%s %.4g)\n", mark, bar.what.c_str(), "no figure", sign,
                   bar.limit);
  }
  return text;
}

}  // namespace

std::string toTable(const Report& report) {
  std::string text = heading(report) + stages(report) + genlock(report.genlock) + bars(report);
  for (const std::string& reason : report.invalid_reasons) text += "\nNOT VALID: " + reason;
  for (const std::string& what : report.run.degraded) text += "\ndegraded: " + what;
  for (const TracedThread& thread : report.run.threads)
    if (!thread.as_asked)
      text += line("\ndegraded: thread %s runs as %s %d, not as configured", thread.name.c_str(),
                   thread.policy.c_str(), thread.priority);
  return text + "\n";
}

}  // namespace appliance
