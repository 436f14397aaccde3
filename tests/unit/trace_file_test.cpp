#include "appliance/trace/trace_file.h"

#include <limits>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using appliance::appendLine;
using appliance::FlipRecord;
using appliance::FrameRecord;
using appliance::Mode;
using appliance::PictureRecord;
using appliance::RunRecord;
using appliance::SetRecord;
using appliance::SummaryRecord;
using appliance::Trace;
using appliance::TriggerRecord;
using rt::fromNs;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::expected<Trace, std::string> read(const std::string& text) {
  std::istringstream in(text);
  return appliance::readTrace(in, "trace.jsonl");
}

std::string faultOf(const std::string& text) {
  const auto trace = read(text);
  return trace ? "no fault" : trace.error();
}

std::string lineOf(const appliance::TraceRecord& record) {
  std::string text;
  appendLine(text, record);
  return text;
}

RunRecord someRun() {
  return {.version = "0.1.0 (a commit)",
          .cameras = 20,
          .width_px = 1280,
          .height_px = 1024,
          .pixel_format = "BayerRG8",
          .trigger_hz = 39.9,
          .display_width_px = 1920,
          .display_height_px = 1080,
          .refresh_hz = 80,
          .renderer = "a \"renderer\"",
          .source_path = "upload: \"why\"",
          .history_sets = 300,
          .memory_bytes = std::numeric_limits<std::uint64_t>::max(),
          .memory_locked = true,
          .threads = {{"trigger", "fifo", 80, 1, true}, {"render", "other", 0, -1, false}},
          .degraded = {"no permission\nfor anything"},
          .start = fromNs(7)};
}

constexpr PictureRecord kPicture{.picture_id = 9,
                                 .mode = Mode::kSweep,
                                 .substitute = true,
                                 .imported = true,
                                 .camera_wanted = 3,
                                 .camera_shown = 4,
                                 .trigger = 77,
                                 .second = {.camera = 5, .trigger = 70},
                                 .wake = fromNs(1),
                                 .target_point_begin = fromNs(2),
                                 .target_point_end = fromNs(3),
                                 .homographies_begin = fromNs(4),
                                 .homographies_end = fromNs(5),
                                 .warp_submit = fromNs(6),
                                 .upload_end = fromNs(7),
                                 .warp_end = fromNs(8),
                                 .commit = fromNs(std::int64_t{1} << 61),
                                 .button_event = fromNs(10)};

TEST(TraceFile, RefusesAnInstantWhoseSumsWouldOverflow) {
  const std::string run = appliance::toLine(someRun());
  const rt::Timestamp latest = fromNs(std::numeric_limits<std::int64_t>::max());
  EXPECT_THAT(faultOf(run + lineOf(SetRecord{1, latest})), HasSubstr("set_complete_ns"));
}

TEST(TraceFile, ReadsBackWhatWasWritten) {
  std::string text = appliance::toLine(someRun());
  appendLine(text, TriggerRecord{12, fromNs(1), fromNs(2), fromNs(3)});
  appendLine(text, FrameRecord{.camera = 19,
                               .status = hal::FrameStatus::kWrongSize,
                               .trigger = 12,
                               .frame_id = 70'000,
                               .first_packet = fromNs(4),
                               .last_packet = fromNs(5),
                               .frame_ready = fromNs(6)});
  appendLine(text, SetRecord{12, fromNs(7)});
  appendLine(text, kPicture);
  appendLine(text, FlipRecord{9, fromNs(11), 13});
  appendLine(text, appliance::LoopbackRecord{12, fromNs(14)});
  appendLine(text, appliance::GenlockRecord{.trigger = 13,
                                            .state = appliance::GenlockState::kAcquiring,
                                            .reason = appliance::GenlockReason::kPhaseLost,
                                            .hold_over = true,
                                            .vblanks_per_trigger = 2,
                                            .phase_error = rt::Nanoseconds(-15),
                                            .lead = rt::Nanoseconds(16),
                                            .vblank_period = rt::Nanoseconds(17),
                                            .unlocks = 18});
  appendLine(text, appliance::StallRecord{3, fromNs(19), fromNs(20)});
  SummaryRecord summary;
  summary.clean_stop = true;
  summary.cpu_seconds = 12.25;
  summary.trace_dropped = 2;
  text += appliance::toLine(summary);

  const auto trace = read(text);
  ASSERT_TRUE(trace.has_value()) << trace.error();
  EXPECT_EQ(trace->run.renderer, "a \"renderer\"");
  EXPECT_EQ(trace->run.source_path, "upload: \"why\"");
  EXPECT_EQ(trace->run.memory_bytes, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(trace->run.trigger_hz, 39.9);
  ASSERT_EQ(trace->run.threads.size(), 2u);
  EXPECT_EQ(trace->run.threads[1].name, "render");
  EXPECT_FALSE(trace->run.threads[1].as_asked);
  EXPECT_EQ(trace->run.degraded.at(0), "no permission\nfor anything");
  ASSERT_TRUE(trace->summary.has_value());
  EXPECT_EQ(trace->summary->cpu_seconds, 12.25);
  // Written again, every record gives the same line: no field was lost or changed on the way.
  std::string again = appliance::toLine(trace->run);
  appendLine(again, trace->triggers.at(0));
  appendLine(again, trace->frames.at(0));
  appendLine(again, trace->sets.at(0));
  appendLine(again, trace->pictures.at(0));
  appendLine(again, trace->flips.at(0));
  appendLine(again, trace->loopbacks.at(0));
  appendLine(again, trace->genlocks.at(0));
  appendLine(again, trace->stalls.at(0));
  EXPECT_EQ(trace->genlocks.at(0).phase_error, rt::Nanoseconds(-15));
  EXPECT_EQ(again + appliance::toLine(*trace->summary), text);
}

TEST(TraceFile, ReadsARunOfBeforeItNamedItsVersion) {
  auto run = nlohmann::json::parse(appliance::toLine(someRun()));
  run.erase("version");
  const auto trace = read(run.dump() + "\n");
  ASSERT_TRUE(trace) << trace.error();
  EXPECT_EQ(trace->run.version, "");
  EXPECT_EQ(trace->run.cameras, 20u);
}

TEST(TraceFile, EveryInstantOfARecordHasItsOwnName) {
  const auto line = nlohmann::json::parse(lineOf(kPicture));
  EXPECT_EQ(line["record"], "picture");
  EXPECT_EQ(line["mode"], "sweep");
  EXPECT_EQ(line["substitute"], true);
  EXPECT_EQ(line["wake_ns"], 1);
  EXPECT_EQ(line["target_point_end_ns"], 3);
  EXPECT_EQ(line["homographies_begin_ns"], 4);
  EXPECT_EQ(line["upload_end_ns"], 7);
  EXPECT_EQ(line["button_event_ns"], 10);
  EXPECT_EQ(line["imported"], true);
  EXPECT_EQ(line["second_trigger"], 70);
  EXPECT_EQ(line.size(), 20u);
}

TEST(TraceFile, ATraceThatWasCutOffIsReadableUpToTheCut) {
  const std::string whole = appliance::toLine(someRun()) + lineOf(SetRecord{1, fromNs(5)}) +
                            lineOf(SetRecord{2, fromNs(6)});
  // Wherever the writer died: never a crash, and only what is whole counts.
  const std::size_t head = appliance::toLine(someRun()).size();
  for (std::size_t size = head; size < whole.size(); ++size) {
    const auto trace = read(whole.substr(0, size));
    ASSERT_TRUE(trace.has_value()) << trace.error();
    EXPECT_LE(trace->sets.size(), 1u);
    EXPECT_FALSE(trace->summary.has_value());
  }
  for (std::size_t size = 0; size + 1 < head; ++size)
    EXPECT_FALSE(read(whole.substr(0, size)).has_value()) << size;
}

TEST(TraceFile, NamesTheLineThatIsWrong) {
  const std::string run = appliance::toLine(someRun());
  EXPECT_THAT(faultOf(""), HasSubstr("this trace is empty"));
  EXPECT_THAT(faultOf("\n"), StartsWith("trace.jsonl:1: "));
  EXPECT_THAT(faultOf(lineOf(SetRecord{})), HasSubstr("first line of a trace is its run record"));
  EXPECT_THAT(faultOf(run + run), AllOf(StartsWith("trace.jsonl:2: "), HasSubstr("second run")));
  EXPECT_THAT(faultOf(run + "[]\n"), HasSubstr("not a JSON object"));
  EXPECT_THAT(faultOf(run + "{\"record\":\"set\",\"trigger\":1\n"), StartsWith("trace.jsonl:2: "));
  EXPECT_THAT(faultOf(run + "{\"record\":\"set\",\"trigger\":1}\n"),
              HasSubstr("no field 'set_complete_ns'"));
  EXPECT_THAT(faultOf(run + "{\"record\":\"set\",\"trigger\":-1,\"set_complete_ns\":1}\n"),
              HasSubstr("field 'trigger' has the wrong type or value"));
  EXPECT_THAT(faultOf(run + "{\"record\":\"set\",\"trigger\":\"1\",\"set_complete_ns\":1}\n"),
              HasSubstr("field 'trigger'"));
  EXPECT_THAT(faultOf(run + "{\"record\":\"set\",\"trigger\":1,\"set_complete_ns\":1e30}\n"),
              HasSubstr("field 'set_complete_ns'"));
  EXPECT_THAT(faultOf(run + "{\"record\":\"dance\"}\n"), HasSubstr("unknown record 'dance'"));
  EXPECT_THAT(faultOf(run + "{\"record\":7}\n"), HasSubstr("unknown record ''"));
  EXPECT_THAT(faultOf(run + appliance::toLine(SummaryRecord{}) + lineOf(SetRecord{})),
              HasSubstr("a record after the summary"));
  EXPECT_THAT(faultOf(run + lineOf(FrameRecord{.camera = someRun().cameras})),
              HasSubstr("a frame of camera"));
  EXPECT_THAT(faultOf("{\"record\":\"run\",\"format\":2}\n"), HasSubstr("not a trace of format 1"));
  EXPECT_THAT(faultOf(run + std::string("\0\xff\n", 3)), StartsWith("trace.jsonl:2: "));
}

TEST(TraceFile, SaysThatAFileCannotBeRead) {
  EXPECT_THAT(appliance::readTraceFile("/nonexistent/t.jsonl").error(),
              AllOf(HasSubstr("/nonexistent/t.jsonl"), HasSubstr("No such file")));
}

}  // namespace
