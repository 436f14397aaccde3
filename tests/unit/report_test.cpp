#include "appliance/tools/report.h"

#include <cstdint>
#include <random>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/tools/report_text.h"
#include "tests/unit/recomputed_report.h"

namespace {

using appliance::computeReport;
using appliance::Report;
using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 5'000'000'000;
constexpr std::int64_t kPeriod_ns = 25'000'000;

/// A run as its files: what the daemon and the emulator would have written.
struct RunFiles {
  std::string trace;
  std::string wire_log =
      "camera,frame_id,trigger,trigger_edge_ns,exposure_end_ns,first_packet_ns,last_packet_ns\n";
};

class RunWriter {
 public:
  explicit RunWriter(int cameras) {
    add({{"record", "run"},
         {"format", 1},
         {"cameras", cameras},
         {"width_px", 64},
         {"height_px", 48},
         {"pixel_format", "BayerRG8"},
         {"trigger_hz", 40.0},
         {"display_width_px", 8},
         {"display_height_px", 6},
         {"refresh_hz", 80.0},
         {"renderer", "a test"},
         {"source_path", "upload: a test"},
         {"history_sets", 300},
         {"memory_bytes", 4096},
         {"memory_locked", true},
         {"threads", json::array()},
         {"degraded", {"a \"b\""}},
         {"start_ns", kStart_ns}});
  }
  void add(const json& line) { files_.trace += line.dump() + "\n"; }
  void trigger(std::int64_t number, std::int64_t deadline_ns, std::int64_t late_ns) {
    add({{"record", "trigger"},
         {"trigger", number},
         {"deadline_ns", deadline_ns},
         {"trigger_edge_before_ns", deadline_ns + late_ns},
         {"trigger_edge_after_ns", deadline_ns + late_ns + 4000}});
  }
  void loopback(std::int64_t trigger, std::int64_t edge_ns) {
    add({{"record", "loopback"}, {"trigger", trigger}, {"edge_ns", edge_ns}});
  }
  void genlock(std::int64_t trigger, const char* state, const char* reason,
               std::int64_t phase_error_ns, std::int64_t lead_ns, int unlocks) {
    add({{"record", "genlock"},
         {"trigger", trigger},
         {"state", state},
         {"reason", reason},
         {"hold_over", false},
         {"vblanks_per_trigger", 2},
         {"phase_error_ns", phase_error_ns},
         {"lead_ns", lead_ns},
         {"vblank_period_ns", kPeriod_ns / 2},
         {"unlocks", unlocks}});
  }
  void frame(int camera, std::int64_t trigger, std::int64_t frame_id, const char* status,
             std::int64_t first_ns, std::int64_t last_ns, std::int64_t ready_ns) {
    add({{"record", "frame"},
         {"camera", camera},
         {"status", status},
         {"trigger", trigger},
         {"frame_id", frame_id},
         {"first_packet_ns", first_ns},
         {"last_packet_ns", last_ns},
         {"frame_ready_ns", ready_ns}});
  }
  void sent(int camera, std::int64_t frame_id, std::int64_t edge_ns, std::int64_t first_ns,
            std::int64_t last_ns) {
    files_.wire_log += std::to_string(camera) + "," + std::to_string(frame_id) + ",1," +
                       std::to_string(edge_ns) + ",0," + std::to_string(first_ns) + "," +
                       std::to_string(last_ns) + "\n";
  }
  void picture(std::int64_t id, const char* mode, int camera, std::int64_t trigger,
               std::int64_t wake_ns, std::int64_t step_ns, std::int64_t button_ns) {
    add({{"record", "picture"},
         {"picture_id", id},
         {"mode", mode},
         {"camera_wanted", camera},
         {"camera_shown", camera},
         {"trigger", trigger},
         {"substitute", false},
         {"imported", id % 3 == 0},
         {"wake_ns", wake_ns},
         {"target_point_begin_ns", wake_ns + step_ns},
         {"target_point_end_ns", wake_ns + 2 * step_ns},
         {"homographies_begin_ns", wake_ns + 2 * step_ns},
         {"homographies_end_ns", wake_ns + 3 * step_ns},
         {"warp_submit_ns", wake_ns + 4 * step_ns},
         {"upload_end_ns", wake_ns + 6 * step_ns},
         {"warp_end_ns", wake_ns + 9 * step_ns},
         {"commit_ns", wake_ns + 10 * step_ns},
         {"button_event_ns", button_ns}});
  }
  void flip(std::int64_t id, std::int64_t flip_ns) {
    add({{"record", "flip"}, {"picture_id", id}, {"page_flip_ns", flip_ns}, {"vblank", id}});
  }
  void stall(int cpu, std::int64_t begin_ns, std::int64_t end_ns) {
    add({{"record", "stall"}, {"cpu", cpu}, {"begin_ns", begin_ns}, {"end_ns", end_ns}});
  }
  void summary(bool clean = true, int dropped = 0) {
    add({{"record", "summary"},
         {"clean_stop", clean},
         {"stop_ns", kStart_ns},
         {"cpu_seconds", 1.5},
         {"memory_bytes", 123456},
         {"frames_lost", 0},
         {"frames_away", 0},
         {"frames_incomplete", 0},
         {"frames_unattributed", 0},
         {"pictures_skipped", 0},
         {"trace_dropped", dropped}});
  }
  [[nodiscard]] const RunFiles& files() const { return files_; }

 private:
  RunFiles files_;
};

Report reportOf(const RunFiles& files, bool with_wire_log, double warm_up_s = 2) {
  std::istringstream trace_in(files.trace);
  const auto trace = appliance::readTrace(trace_in, "trace.jsonl");
  EXPECT_TRUE(trace.has_value()) << trace.error();
  std::istringstream wire_in(files.wire_log);
  const auto wire = appliance::readWireLog(wire_in, "wire.csv");
  EXPECT_TRUE(wire.has_value()) << wire.error();
  return computeReport({.trace = *trace,
                        .wire_log = with_wire_log ? &*wire : nullptr,
                        .emulator = nullptr,
                        .warm_up_s = warm_up_s});
}

/// Five seconds of three cameras through all modes, with everything that can go wrong in them.
RunFiles eventfulRun() {
  constexpr int kCameras = 3;
  constexpr std::int64_t kTriggers = 200;
  std::mt19937 random(7);  // NOLINT(bugprone-random-generator-seed): the same run every time
  const auto upTo = [&](std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(0, most)(random);
  };
  RunWriter run(kCameras);
  std::int64_t picture = 0;
  for (std::int64_t t = 1; t <= kTriggers; ++t) {
    const std::int64_t late_ns = upTo(200'000);
    const std::int64_t edge_ns = kStart_ns + t * kPeriod_ns + late_ns;
    run.trigger(t, edge_ns - late_ns, late_ns);
    if (t == 1) run.genlock(t, "free_running", "no_vblanks", 0, 0, 0);
    if (t == 10) run.genlock(t, "acquiring", "none", 3'000'000, 21'000'000, 0);
    if (t % 10 == 0 && t >= 20 && t != 60)
      run.genlock(t, "locked", "none", 20'000 - upTo(40'000), 25'000'000 + upTo(200'000), t > 60);
    if (t == 60) run.genlock(t, "acquiring", "phase_lost", 700'000, 25'000'000, 1);
    if (t % 40 == 0) {  // two processors, one after the other; the first again a little later
      run.stall(0, edge_ns + upTo(5'000'000), edge_ns + 60'000'000);
      run.stall(1, edge_ns + 40'000'000, edge_ns + 90'000'000 + upTo(5'000'000));
      run.stall(0, edge_ns + 200'000'000, edge_ns + 210'000'000);
    }
    // A lost edge, and one near no trigger: neither is a delay.
    if (t % 50 != 0) run.loopback(t % 50 == 1 ? 0 : t, edge_ns + 3000 + upTo(9000));
    for (int camera = 0; camera < kCameras; ++camera) {
      const std::int64_t id = t + 65500;  // wraps on the wire
      const std::int64_t first_ns = edge_ns + 1'200'000 + upTo(300'000);
      const std::int64_t last_ns = first_ns + 10'000'000 + upTo(2'000'000);
      const std::int64_t ready_ns = last_ns + upTo(500'000);
      const std::int64_t fate = upTo(40);
      if (fate == 0) continue;  // lost
      run.sent(camera, (id - 1) % 65535 + 1, edge_ns + 2000, first_ns - 50'000, last_ns - 90'000);
      const char* status = fate == 1 ? "incomplete" : fate == 2 ? "aborted" : "complete";
      run.frame(camera, fate == 3 ? 0 : t, id, status, first_ns, last_ns, ready_ns);
      if (fate == 4) run.frame(camera, t, id, status, first_ns, last_ns, ready_ns + 1000);
    }
    const char* mode = t <= 80    ? "live"
                       : t <= 130 ? "delayed"
                       : t <= 150 ? "frozen"
                       : t <= 170 ? "sweep"
                       : t <= 190 ? "slow"
                                  : "live";
    const std::int64_t shown = mode[0] == 'l' ? t : mode[0] == 'd' ? t - 40 : 120;
    for (int refresh = 0; refresh < 2; ++refresh) {
      ++picture;
      const std::int64_t wake_ns = edge_ns + 13'000'000 + refresh * 12'500'000;
      const std::int64_t step_ns = 100'000 + upTo(900'000);
      const std::int64_t empty = t == 60 ? 0 : shown;
      if (refresh == 1 && upTo(2) > 0) continue;
      run.picture(picture, mode, mode[0] == 's' ? static_cast<int>(t % 3) : 1, empty, wake_ns,
                  step_ns, t % 20 == 0 ? wake_ns - 3'000'000 : 0);
      if (upTo(30) > 0) run.flip(picture, wake_ns + 10 * step_ns + upTo(12'000'000));
    }
  }
  run.summary();
  return run.files();
}

class RecomputedFigures : public testing::TestWithParam<bool> {};

TEST_P(RecomputedFigures, AreTheReportsFigures) {
  const bool with_wire_log = GetParam();
  const RunFiles files = eventfulRun();
  const json report = json::parse(appliance::toJson(reportOf(files, with_wire_log)));
  std::istringstream trace(files.trace);
  std::istringstream wire(files.wire_log);
  const json recomputed = recomputedReport(trace, with_wire_log ? &wire : nullptr, 2);
  expectSameFigures(report, recomputed);

  // The run must have held what the figures are about.
  EXPECT_GT(report["frames_lost"], 0);
  EXPECT_GT(report["frames_incomplete"], 0);
  EXPECT_GT(report["frames_unattributed"], 0);
  EXPECT_LT(report["after_warm_up"]["frames_lost"], report["frames_lost"]);
  EXPECT_EQ(report["stalls"]["count"], 10);
  for (const char* counted : {"frames_lost", "frames_incomplete"}) {
    EXPECT_GT(report[std::string(counted) + "_in_stalls"], 0);
    EXPECT_LT(report[std::string(counted) + "_in_stalls"], report[counted]);
  }
  EXPECT_GT(report["pictures_repeated"], 0);
  for (const auto& [name, stage] : report["stages_ms"].items())
    EXPECT_GT(stage["count"], 50) << name;
  EXPECT_EQ(report["trigger_edge_delay_us"]["count"], 192);
  EXPECT_GT(report["trigger_edge_delay_us"]["sd"], 1);
  EXPECT_EQ(report["genlock"]["unlocks"].size(), 1);
  EXPECT_GE(report["genlock"]["trigger_to_flip_vblanks"]["histogram"].size(), 2);
  EXPECT_GT(report["genlock"]["trigger_edge_to_page_flip_ms"]["locked"]["count"], 30);
  EXPECT_GT(report["genlock"]["trigger_edge_to_page_flip_ms"]["free_running"]["count"], 10);
  for (const auto& [name, mode] : report["by_mode"].items())
    EXPECT_GT(mode["pictures"], 10) << name;
  EXPECT_EQ(report["last_packet_from"], with_wire_log ? "wire log" : "trace");
}

INSTANTIATE_TEST_SUITE_P(Report, RecomputedFigures, testing::Bool(),
                         [](const auto& run) { return run.param ? "WithWireLog" : "TraceAlone"; });

/// Two cameras, four triggers, every picture at hand: figures that fit on paper.
RunWriter paperRun() {
  RunWriter run(2);
  for (std::int64_t t = 1; t <= 4; ++t) {
    const std::int64_t edge_ns = kStart_ns + t * kPeriod_ns;
    run.trigger(t, edge_ns - 10'000, 10'000);
    for (int camera = 0; camera < 2; ++camera) {
      if (t == 3 && camera == 1) continue;  // one frame is lost
      run.sent(camera, t, edge_ns, edge_ns + 1'000'000, edge_ns + 11'000'000);
      run.frame(camera, t, t, "complete", edge_ns + 1'000'000, edge_ns + 12'000'000,
                edge_ns + 12'100'000);
    }
    run.picture(t, "live", 0, t, edge_ns + 12'000'000, 100'000, t == 2 ? edge_ns : 0);
    run.flip(t, edge_ns + 20'000'000);
  }
  return run;
}

TEST(Report, GivesTheFiguresThatPaperGives) {
  RunWriter run = paperRun();
  run.summary();
  const Report report = reportOf(run.files(), true, 0.05);
  EXPECT_EQ(report.whole.triggers, 4u);
  EXPECT_DOUBLE_EQ(report.whole.seconds, 0.1);
  EXPECT_EQ(report.whole.frames_expected, 8u);
  EXPECT_EQ(report.whole.frames_received, 7u);
  EXPECT_EQ(report.whole.frames_lost, 1u);
  EXPECT_EQ(report.after_warm_up.triggers, 2u);  // 50 ms hold two triggers
  EXPECT_EQ(report.after_warm_up.frames_expected, 4u);
  EXPECT_EQ(report.after_warm_up.frames_lost, 1u);
  EXPECT_DOUBLE_EQ(report.shown_fps, 40);  // three sets in 75 ms; the fourth has no duration
  EXPECT_EQ(report.pictures_repeated, 0u);
  EXPECT_NEAR(report.trigger_lateness_us.mean, 14, 1e-9);
  EXPECT_NEAR(report.stages_ms.trigger_edge_to_frame_ready.p50, 12.1, 1e-9);
  EXPECT_NEAR(report.stages_ms.last_packet_to_commit.p50, 2, 1e-9);  // 13 - 11, not 13 - 12
  EXPECT_NEAR(report.stages_ms.warp.max, 0.3, 1e-9);
  EXPECT_NEAR(report.stages_ms.commit_to_flip.mean, 7, 1e-9);
  EXPECT_NEAR(report.stages_ms.trigger_edge_to_page_flip.p99, 20, 1e-9);
  EXPECT_EQ(report.button_to_commit_ms.count, 1u);
  EXPECT_NEAR(report.button_to_commit_ms.max, 13, 1e-9);
  EXPECT_TRUE(report.valid);
  EXPECT_EQ(reportOf(run.files(), false).stages_ms.last_packet_to_commit.p50, 1);
}

TEST(Report, MarksTheBarsByTheFigures) {
  RunWriter run = paperRun();
  run.summary();
  const Report report = reportOf(run.files(), true, 0);
  const auto mark = [&](const std::string& what) {
    for (const auto& bar : report.bars)
      if (bar.what.starts_with(what)) return bar.passed();
    ADD_FAILURE() << "no bar " << what;
    return std::optional<bool>();
  };
  EXPECT_EQ(mark("valid"), true);
  EXPECT_EQ(mark("frames_lost"), false);
  EXPECT_EQ(mark("frames_incomplete"), true);
  EXPECT_EQ(mark("shown_fps"), true);
  EXPECT_EQ(mark("last_packet_to_commit p99"), true);
  EXPECT_EQ(mark("button_to_commit p99"), true);
  EXPECT_EQ(mark("homographies mean"), false);  // 0.1 ms
  const std::string table = appliance::toTable(report);
  EXPECT_THAT(table, HasSubstr("FAIL  frames_lost after warm-up"));
  EXPECT_THAT(table, HasSubstr("PASS  shown_fps"));
  EXPECT_THAT(table, HasSubstr("visible delay about 120"));
}

TEST(Report, DoesNotHoldLossesWithinAStallAgainstTheBars) {
  RunWriter run = paperRun();  // camera 2 lost the frame of trigger 3
  const std::int64_t edge_ns = kStart_ns + 3 * kPeriod_ns;
  run.stall(0, edge_ns + 5'000'000, edge_ns + 30'000'000);
  run.stall(1, edge_ns + 20'000'000, edge_ns + 45'000'000);
  run.summary();
  const Report report = reportOf(run.files(), true, 0);
  EXPECT_EQ(report.stalls.count, 1u);
  EXPECT_DOUBLE_EQ(report.stalls.longest_ms, 40);
  EXPECT_EQ(report.whole.frames_lost, 1u);
  EXPECT_EQ(report.whole.frames_lost_in_stalls, 1u);
  EXPECT_THAT(appliance::toTable(report), HasSubstr("PASS  frames_lost after warm-up"));
  EXPECT_THAT(appliance::toTable(report),
              HasSubstr("this PC stood still 1 times, for 40.0 ms at most (firmware or host): "
                        "1 frames lost and 0 incomplete meanwhile, not judged"));
}

TEST(Report, ExcusesNoLossFarFromAStall) {
  RunWriter run = paperRun();
  const std::int64_t edge_ns = kStart_ns + 3 * kPeriod_ns;
  run.stall(0, edge_ns + 2 * kPeriod_ns + 1, edge_ns + 5 * kPeriod_ns);
  run.stall(0, edge_ns - 3 * kPeriod_ns, edge_ns - kPeriod_ns - 1);
  run.summary();
  EXPECT_EQ(reportOf(run.files(), true, 0).whole.frames_lost_in_stalls, 0u);
}

TEST(Report, SaysWhyARunIsNotValid) {
  EXPECT_THAT(reportOf(paperRun().files(), true).invalid_reasons,
              Contains(HasSubstr("incomplete")));
  RunWriter dropped = paperRun();
  dropped.summary(true, 3);
  EXPECT_THAT(reportOf(dropped.files(), true).invalid_reasons,
              Contains(HasSubstr("lost 3 records")));
  RunWriter unclean = paperRun();
  unclean.summary(false);
  EXPECT_FALSE(reportOf(unclean.files(), true).valid);

  RunWriter run = paperRun();
  run.summary();
  std::istringstream in(run.files().trace);
  const auto trace = appliance::readTrace(in, "t");
  ASSERT_TRUE(trace.has_value()) << trace.error();
  const appliance::EmulatorStatistics late{.valid = false, .invalid_reason = "packets left late"};
  const Report report = computeReport({.trace = *trace, .emulator = &late});
  EXPECT_THAT(report.invalid_reasons, Contains(HasSubstr("packets left late")));
}

TEST(Report, FindsAFrameThatWasGivenToTheNeighbouringTrigger) {
  RunWriter run = paperRun();
  const std::int64_t edge_ns = kStart_ns + 5 * kPeriod_ns;
  run.trigger(5, edge_ns, 0);
  run.sent(0, 5, edge_ns - kPeriod_ns, edge_ns, edge_ns + 10);  // answered trigger 4
  run.frame(0, 5, 5, "complete", edge_ns, edge_ns + 10, edge_ns + 20);
  run.summary();
  const Report report = reportOf(run.files(), true);
  EXPECT_EQ(report.frames_misattributed, 1u);
  EXPECT_FALSE(report.valid);
  EXPECT_EQ(reportOf(run.files(), false).frames_misattributed, std::nullopt);
}

TEST(Report, OfARunWithoutAnythingHasNoFiguresAndDoesNotPass) {
  RunWriter run(20);
  run.summary();
  const Report report = reportOf(run.files(), true);
  EXPECT_FALSE(report.valid);
  EXPECT_EQ(report.whole.frames_expected, 0u);
  const json out = json::parse(appliance::toJson(report));
  EXPECT_TRUE(out["stages_ms"]["warp"]["mean"].is_null());
  EXPECT_TRUE(out["bars"][3]["passed"].is_null());
  EXPECT_THAT(appliance::toTable(report), HasSubstr("----  shown_fps"));
}

TEST(EmulatorFiles, RefuseWhatTheyAreNotInOneLine) {
  const auto wireFault = [](const std::string& text) {
    std::istringstream in(text);
    const auto log = appliance::readWireLog(in, "wire.csv");
    return log ? std::string("no fault") : log.error();
  };
  const std::string header = RunFiles{}.wire_log;
  EXPECT_THAT(wireFault(""), HasSubstr("wire.csv:1: "));
  EXPECT_THAT(wireFault("a,b,c\n"), HasSubstr("not a wire log"));
  EXPECT_THAT(wireFault(header + "1,2,3\n"), HasSubstr("wire.csv:2: "));
  EXPECT_THAT(wireFault(header + "1,2,3,4,5,6,7\n1,2,3,4,5,6,seven\n"), HasSubstr("wire.csv:3: "));
  EXPECT_THAT(wireFault(header + "1,2,3,4,5,6,7,8\n"), HasSubstr("wire.csv:2: "));
  EXPECT_THAT(wireFault(header + "-1,2,3,4,5,6,7\n"), HasSubstr("wire.csv:2: "));
  EXPECT_EQ(wireFault(header + "1,2,3,4,5,6,7\n1,2,3,4"), "no fault");  // cut off while writing

  const auto statsFault = [](const std::string& text) {
    std::istringstream in(text);
    const auto stats = appliance::readEmulatorStatistics(in, "stats.json");
    return stats ? std::string("no fault") : stats.error();
  };
  for (const char* text : {"", "{", "[]", "7", R"({"valid": 1})", R"({"valid": true})"})
    EXPECT_THAT(statsFault(text), HasSubstr("stats.json: ")) << text;
  EXPECT_EQ(statsFault(R"({"valid": true, "invalid_reason": "", "frames_sent": 1,)"
                       R"( "cpu_seconds": 0.5})"),
            "no fault");
}

}  // namespace
