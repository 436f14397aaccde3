// The whole box in one go: libgpiod's trigger line -> bridge -> cameras -> frame history -> warp ->
// VKMS, driven by presses on GPIO lines. What was shown is read back from what was scanned out.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "appliance/geometry/homography.h"
#include "appliance/geometry/rig_file.h"
#include "tests/kernel/support/scanout_witness.h"
#include "tests/kernel/support/whole_box.h"
#include "tests/support/child_process.h"
#include "tests/support/shown_picture.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::WholeBox;

/// One picture off the screen, with the mode that the box was in.
struct Still {
  std::string mode;
  test::WitnessedScanout scanout;
};

cv::Mat toBgr(const test::WitnessedScanout& scanout) {
  std::vector<std::uint32_t> pixels = scanout.pixels;
  const cv::Mat bgrx(static_cast<int>(scanout.height_px), static_cast<int>(scanout.width_px),
                     CV_8UC4, pixels.data());
  cv::Mat bgr;
  cv::cvtColor(bgrx, bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

/// The stamp on a picture that may show any camera of the rig.
std::optional<emulator::Stamp> readStamp(const test::WitnessedScanout& scanout,
                                         const appliance::Rig& rig) {
  for (const appliance::RigCamera& camera : rig.cameras) {
    const appliance::View view =
        viewOf(camera, rig, rig.target_m,
               {.width_px = scanout.width_px, .height_px = scanout.height_px, .zoom = 1});
    test::ShownPicture shown;
    std::ranges::copy(view.H_camera_display, shown.H_camera_display.val);
    const hal::Lens& lens = camera.lens;
    shown.camera_matrix = {lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1};
    std::ranges::copy(lens.distortion, shown.distortion.val);
    shown.picture = toBgr(scanout);
    const auto stamp = shown.readStamp({WholeBox::kWidthPx, WholeBox::kHeightPx});
    if (stamp && &rig.cameras[stamp->camera] == &camera) return stamp;
  }
  return std::nullopt;
}

/// One run through all modes; what it left is read back. Its folder is kept.
class DaemonRun {
 public:
  DaemonRun() {
    WholeBox box(folder_);
    if (!box.running()) return;
    if (!box.waitForMode("live")) return;  // a screen that is dark has no witness
    test::ScanoutWitness witness;
    show(box, witness, "live", "", "live");
    show(box, witness, "delayed", "delay-more", "delayed");
    show(box, witness, "live", "live", "live");
    std::this_thread::sleep_for(1s);
    show(box, witness, "frozen", "freeze", "frozen");
    show(box, witness, "sweep", "sweep", "frozen");
    show(box, witness, "live", "live", "live");
    box.stop();
    daemon_exit = box.daemon_exit.value_or(-1);
    emulator_exit = box.emulator_exit.value_or(-1);
    daemon_output = box.daemon_output;
    trigger_level_after = box.triggerLevel();
    if (daemon_exit != 0) return;

    records = test::readTrace(box.path("trace.jsonl"));
    if (auto loaded = appliance::loadRig(box.path("rig.toml"))) rig = *loaded;
    test::ChildProcess report(
        {KAGAMI, "report", "--trace", box.path("trace.jsonl"), "--wire-log", box.path("wire.csv"),
         "--emulator-stats", box.path("stats.json"), "--out", box.path("report.json")},
        box.path("report.log"));
    report_exit = report.wait(60s).value_or(-1);
    report_output = report.output();
    std::ifstream written(box.path("report.json"));
    if (written) figures = json::parse(written, nullptr, false);
  }

  /// The edge that the cameras took for their trigger @p number.
  [[nodiscard]] std::optional<std::int64_t> edgeOnTheWire(std::uint64_t number) const {
    std::ifstream log(folder_ + "/wire.csv");
    std::string line;
    std::getline(log, line);
    while (std::getline(log, line)) {
      int camera = 0;
      unsigned long frame_id = 0;
      unsigned long trigger = 0;
      long edge_ns = 0;
      if (std::sscanf(line.c_str(), "%d,%lu,%lu,%ld", &camera, &frame_id, &trigger, &edge_ns) ==
              4 &&
          trigger == number) {
        return edge_ns;
      }
    }
    return std::nullopt;
  }

  int daemon_exit = -1;
  int emulator_exit = -1;
  int report_exit = -1;
  bool trigger_level_after = true;
  std::string daemon_output;
  std::string report_output;
  appliance::Rig rig;
  json figures;
  std::map<std::string, std::vector<json>> records;
  std::vector<Still> stills;

 private:
  /// Presses @p button, waits for its effect and keeps what is on the screen then.
  void show(WholeBox& box, test::ScanoutWitness& witness, const std::string& mode,
            const std::string& button, const std::string& lamp) {
    if (!button.empty()) box.tap(button);
    EXPECT_TRUE(box.waitForMode(mode)) << mode << " is not reached";
    EXPECT_TRUE(box.waitForLamp(lamp, true)) << mode << " lights no lamp " << lamp;
    std::this_thread::sleep_for(1s);
    auto scanout = witness.read(10s);
    if (!scanout) {
      ADD_FAILURE() << "no picture of " << mode << " could be read back";
      return;
    }
    cv::imwrite(folder_ + "/" + mode + ".png", toBgr(*scanout));
    stills.push_back({.mode = mode, .scanout = std::move(*scanout)});
  }

  std::string folder_ = std::filesystem::current_path();
};

const DaemonRun& throughAllModes() {
  static const DaemonRun run;
  return run;
}

TEST(WholeBox, RunsThroughAllModesAndEndsCleanly) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0) << run.daemon_output;
  EXPECT_EQ(run.emulator_exit, 0);
  EXPECT_FALSE(run.trigger_level_after);
  std::set<std::string> modes;
  for (const json& picture : run.records.at("picture")) modes.insert(picture["mode"]);
  EXPECT_THAT(modes, testing::UnorderedElementsAre("live", "delayed", "frozen", "sweep"));
  EXPECT_TRUE(run.records.at("summary").front()["clean_stop"]);
  EXPECT_THAT(run.records.at("run").front()["display_width_px"].get<int>(), 640);
}

TEST(WholeBox, LosesNoFrame) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0);
  const std::size_t triggers = run.records.at("trigger").size();
  EXPECT_GT(triggers, 60U);
  std::size_t complete = 0;
  for (const json& frame : run.records.at("frame")) {
    if (frame["status"] == "complete" && frame["trigger"] != 0) ++complete;
  }
  EXPECT_EQ(complete, triggers * WholeBox::kCameras);
}

TEST(WholeBox, ScansOutTheFrameThatTheTraceSays) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0);
  ASSERT_EQ(run.stills.size(), 6U);
  for (const Still& still : run.stills) {
    const json* flip = nullptr;  // the picture that was on the screen at that vblank
    for (const json& record : run.records.at("flip")) {
      if (record["vblank"] <= still.scanout.vblank) flip = &record;
    }
    ASSERT_NE(flip, nullptr) << still.mode;
    const json* picture = nullptr;
    for (const json& record : run.records.at("picture")) {
      if (record["picture_id"] == (*flip)["picture_id"]) picture = &record;
    }
    ASSERT_NE(picture, nullptr) << still.mode;
    EXPECT_EQ((*picture)["mode"], still.mode);

    const auto stamp = readStamp(still.scanout, run.rig);
    ASSERT_TRUE(stamp) << still.mode << ": the stamp cannot be read";
    EXPECT_EQ((*picture)["camera_shown"], stamp->camera) << still.mode;
    // The loop-back's test pulse fires the cameras too: edges compare, counts need not.
    const auto edge_ns = run.edgeOnTheWire(stamp->trigger);
    ASSERT_TRUE(edge_ns) << still.mode;
    const auto& triggers = run.records.at("trigger");
    const auto trigger = std::ranges::find_if(
        triggers, [&](const json& record) { return record["trigger"] == (*picture)["trigger"]; });
    ASSERT_NE(trigger, triggers.end()) << still.mode;
    EXPECT_GE(*edge_ns, (*trigger)["trigger_edge_before_ns"]) << still.mode;
    EXPECT_LE(*edge_ns, (*trigger)["trigger_edge_after_ns"]) << still.mode;
  }
}

TEST(WholeBox, ShowsEveryCameraInASweep) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0);
  std::set<int> cameras;
  for (const json& picture : run.records.at("picture")) {
    if (picture["mode"] == "sweep") cameras.insert(picture["camera_shown"].get<int>());
  }
  EXPECT_GE(cameras.size(), 2U);
}

TEST(WholeBox, GetsAValidReport) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.daemon_exit, 0);
  ASSERT_EQ(run.report_exit, 0) << run.report_output;
  EXPECT_TRUE(run.figures["valid"]) << run.figures["invalid_reasons"];
  EXPECT_EQ(run.figures["frames_lost"], 0);
  EXPECT_EQ(run.figures["frames_incomplete"], 0);
  EXPECT_EQ(run.figures["frames_misattributed"], 0);
}

TEST(WholeBox, GivesEveryLockedPictureItsVblank) {
  const DaemonRun& run = throughAllModes();
  ASSERT_EQ(run.report_exit, 0) << run.report_output;
  EXPECT_EQ(run.figures["genlock"]["state"], "locked");
  EXPECT_TRUE(run.figures["genlock"]["unlocks"].empty());
  EXPECT_GT(run.figures["genlock"]["lead_ms"]["p50"], 0) << "the trigger comes before its picture";
  std::vector<int> pictures;
  for (const auto& [vblanks, count] :
       run.figures["genlock"]["trigger_to_flip_vblanks"]["histogram"].items()) {
    pictures.push_back(count.get<int>());
  }
  ASSERT_FALSE(pictures.empty());
  const int usual = std::ranges::max(pictures);
  int all = 0;
  for (const int count : pictures) all += count;
  EXPECT_GE(usual, 20);
  // A press into live is answered immediately, by a moment that had its vblank already.
  constexpr int kPressesIntoLive = 2;
  EXPECT_LE(all - usual, kPressesIntoLive) << run.figures["genlock"].dump(1);
}

}  // namespace
