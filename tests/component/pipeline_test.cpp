// The real programs over real packets: emulated cameras on one side of the wire, kagamid on the
// other. What was shown is read back from the pictures themselves.

#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appliance/tools/emulator_files.h"
#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/shown_picture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thread_table.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr int kCameras = 4;
const test::CameraNetwork kNetwork{
    .first_address = "127.0.4.1", .cameras = kCameras, .wire_port = 3994};

/// One run of both programs with a scripted panel; everything they wrote is read back.
class PipelineRun {
 public:
  explicit PipelineRun(const std::string& script, std::chrono::seconds length) {
    std::ofstream(folder_ / "panel.txt") << script;
    test::ChildProcess emulator(
        emulatorCommand(kNetwork, "640x480", folder_.path(),
                        {"--wire-log", path("wire.csv"), "--stats", path("stats.json")}),
        folder_ / "emulator.log");
    if (!emulator.waitForOutput("ready", 30s)) {
      ADD_FAILURE() << emulator.output();
      return;
    }
    test::ChildProcess daemon(
        kagamidCommand(
            kNetwork, folder_.path(),
            {"panel.backend=scripted", "panel.script=" + path("panel.txt"),
             "record.directory=" + path("record"), "state.trace=" + path("trace.jsonl")}),
        folder_ / "kagamid.log");
    if (!daemon.waitForOutput("running:", 60s)) {
      ADD_FAILURE() << daemon.output();
      return;
    }
    std::this_thread::sleep_for(length);
    daemon.terminate();
    daemon_exit = daemon.wait(60s).value_or(-1);
    daemon_output = daemon.output();
    emulator.terminate();
    emulator_exit = emulator.wait(20s).value_or(-1);
    if (daemon_exit != 0) return;  // its trace may end anywhere
    records = test::readTrace(folder_ / "trace.jsonl");
    pictures = test::readStills(folder_ / "record");
  }

  std::string path(const std::string& name) const { return folder_ / name; }

  int daemon_exit = -1;
  int emulator_exit = -1;
  std::string daemon_output;
  std::map<std::string, std::vector<json>> records;
  std::vector<test::ShownPicture> pictures;  // the kept stills

 private:
  test::TemporaryFolder folder_;
};

const PipelineRun& throughAllModes() {
  static const PipelineRun run(
      "2.5 tap delay-more\n"
      "4.5 tap freeze\n"
      "5.5 tap sweep\n"
      "7.5 tap live\n",
      10s);
  return run;
}

TEST(Pipeline, ShowsTheCameraAndTheTriggerThatItSaysItShows) {
  const PipelineRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0) << run.daemon_output;
  ASSERT_GE(run.pictures.size(), 4U);
  std::set<std::string> modes;
  for (const test::ShownPicture& picture : run.pictures) {
    const auto stamp = picture.readStamp({640, 480});
    ASSERT_TRUE(stamp) << picture.name << ": the stamp cannot be read";
    EXPECT_EQ(stamp->camera, picture.camera) << picture.name;
    EXPECT_EQ(stamp->trigger, picture.trigger) << picture.name;
    modes.insert(picture.mode);
  }
  EXPECT_THAT(modes, testing::UnorderedElementsAre("live", "delayed", "frozen", "sweep"));
}

TEST(Pipeline, StoresEveryFrameOfEveryTriggerUnderItsOwnTrigger) {
  const PipelineRun& run = throughAllModes();
  std::ifstream log(run.path("wire.csv"));
  const auto frames_sent = appliance::readWireLog(log, "wire.csv");
  ASSERT_TRUE(frames_sent) << frames_sent.error();
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::uint64_t> sent;  // camera, frame id
  for (const appliance::SentFrame& frame : *frames_sent) {
    sent[{frame.camera, frame.frame_id}] = frame.trigger;
  }
  std::size_t stored = 0;
  for (const json& frame : run.records.at("frame")) {
    const std::uint64_t trigger = frame["trigger"];
    if (trigger == 0) continue;
    ++stored;
    EXPECT_EQ((sent[{frame["camera"], frame["frame_id"]}]), trigger) << frame;
  }
  EXPECT_GT(stored, 0U);
  EXPECT_EQ(stored, run.records.at("trigger").size() * kCameras) << "frames were lost";
  EXPECT_EQ(run.records.at("summary").front()["frames_incomplete"], 0);
}

TEST(Pipeline, CommitsAPictureForEveryPress) {
  const PipelineRun& run = throughAllModes();
  std::size_t answered = 0;
  for (const json& picture : run.records.at("picture")) {
    if (picture["button_event_ns"] != 0) {
      ++answered;
      EXPECT_GT(picture["commit_ns"], picture["button_event_ns"]);
    }
  }
  EXPECT_EQ(answered, 4U);
}

TEST(Pipeline, KeepsTheOrderOfInstantsInEveryPicture) {
  const PipelineRun& run = throughAllModes();
  for (const json& picture : run.records.at("picture")) {
    if (picture["trigger"] == 0) continue;
    std::int64_t before = 0;
    for (const char* instant :
         {"wake_ns", "target_point_begin_ns", "target_point_end_ns", "homographies_begin_ns",
          "homographies_end_ns", "warp_submit_ns", "upload_end_ns", "warp_end_ns", "commit_ns"}) {
      EXPECT_GE(picture[instant], before) << instant << " of " << picture;
      before = picture[instant];
    }
  }
}

TEST(Pipeline, SaysHowFramesReachTheRendererForTheRunAndForEachPicture) {
  const PipelineRun& run = throughAllModes();
  const std::string path = run.records.at("run").front()["source_path"];
  const std::string why = "upload: ";
  EXPECT_TRUE(path == "dma-buf" || (path.starts_with(why) && path.size() > why.size())) << path;
  for (const json& picture : run.records.at("picture")) {
    EXPECT_EQ(picture["imported"], path == "dma-buf" && picture["trigger"] != 0) << picture;
  }
}

TEST(Pipeline, RunsOnlyTheThreadsOfTheThreadTable) {
  const PipelineRun& run = throughAllModes();
  const std::map<std::string, test::TableRow> table = test::readThreadTable(KAGAMI_THREAD_TABLE);
  ASSERT_FALSE(table.empty());
  std::set<std::string> seen;
  for (const json& thread : run.records.at("run").front()["threads"]) {
    const std::string name = test::tableName(thread["name"]);
    const auto row = table.find(name);
    ASSERT_NE(row, table.end()) << name << " is not in docs/real-time.md";
    seen.insert(name);
    // Without permission every thread runs as SCHED_OTHER, and the daemon says so.
    if (run.daemon_output.find("without its real-time priority") == std::string::npos) {
      EXPECT_EQ(thread["policy"], row->second.policy) << name;
      EXPECT_EQ(thread["priority"], row->second.priority) << name;
    }
  }
  for (const char* name : {"main", "render", "panel", "trigger", "recv"}) {
    EXPECT_TRUE(seen.contains(name)) << name << " does not run";
  }
}

}  // namespace
