// The rig of a running box is replaced a thousand times: emulated cameras, real packets, the real
// parts. What every picture was drawn by is held against each rig, and its pixels against that.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "appliance/box/box.h"
#include "appliance/geometry/rig_file.h"
#include "appliance/geometry/view_set.h"
#include "appliance/site/site.h"
#include "appliance/tools/emulator_files.h"
#include "appliance/trace/trace_file.h"
#include "hal/emulated/rig/arc_rig.h"
#include "rt/periodic_loop.h"
#include "tests/soak/judgement.h"
#include "tests/soak/loss_account.h"
#include "tests/support/becomes_true.h"
#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/shown_picture.h"
#include "tests/support/temporary_folder.h"
#include "ui-kms/offscreen_display.h"

namespace {

using namespace std::chrono_literals;
using appliance::Rig;

const test::CameraNetwork kNetwork{.first_address = "127.0.42.1", .cameras = 8, .wire_port = 4192};
constexpr emulator::SizePx kSource{640, 480};
const cv::Size kScreen(640, 360);
constexpr std::uint64_t kSwaps = 1000;
constexpr auto kBetweenSwaps = 12ms;
constexpr rt::Nanoseconds kPeriod = 25ms;
constexpr double kZoom = 1;

/// The emulator's cameras, calibrated. Every second calibration has other principal points, another
/// distortion, another target and other colours; no two have the same focal lengths.
std::string calibration(std::uint64_t number) {
  emulator::RigModel rig =
      emulator::makeArcRig(static_cast<std::uint32_t>(kNetwork.cameras), kSource);
  const bool odd = number % 2 == 1;
  for (emulator::CameraModel& camera : rig.cameras) {
    camera.focal_px[0] += 0.001 * static_cast<double>(number);
    camera.gain_rgb = odd ? std::array{0.3, 0.6, 1.0} : std::array{1.0, 0.6, 0.3};
    if (!odd) continue;
    camera.centre_px[0] += 30;  // nearly two cells of the stamp
    camera.centre_px[1] += 10;
    camera.distortion[0] -= 0.02;
  }
  if (odd) rig.target_m[2] += 0.05;
  return toToml(rig);
}

/// One picture as it was drawn, and what its pixels say.
struct Seen {
  hal::WarpPlan plan;
  std::uint32_t camera = 0;
  std::uint64_t trigger = 0;
  std::optional<emulator::Stamp> stamp;
  bool reddish = false;
};

/// Reads every picture back.
class Watcher final : public appliance::PictureObserver {
 public:
  explicit Watcher(ui::PictureSource& source) : source_(source), rgba_(kScreen) {
    seen_.reserve(10'000);
  }

  void onPicture(const appliance::ShownPicture& picture) noexcept override {
    if (picture.scene.count == 0) return;
    Seen seen{.plan = picture.scene.layers[0].plan,
              .camera = picture.record.camera_shown,
              .trigger = picture.record.trigger};
    if (source_.readPicture({reinterpret_cast<std::byte*>(rgba_.data), rgba_.total() * 4})) {
      look(seen);
    }
    focal_px = seen.plan.lens.fx_px;
    if (seen_.size() < seen_.capacity()) seen_.push_back(seen);
  }

  /// After the render thread's end.
  [[nodiscard]] const std::vector<Seen>& seen() const { return seen_; }

  std::atomic<double> focal_px = 0;  ///< of the newest picture

 private:
  void look(Seen& seen) {
    const hal::Lens& lens = seen.plan.lens;
    test::ShownPicture shown;
    shown.camera_matrix = {lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1};
    std::ranges::copy(lens.distortion, shown.distortion.val);
    std::ranges::copy(seen.plan.H_camera_display, shown.H_camera_display.val);
    cv::cvtColor(rgba_, shown.picture, cv::COLOR_RGBA2BGR);
    seen.stamp = shown.readStamp(cv::Size(kSource.width, kSource.height));
    const cv::Scalar mean = cv::mean(rgba_);
    seen.reddish = mean[0] > mean[2];
  }

  ui::PictureSource& source_;
  cv::Mat4b rgba_;
  std::vector<Seen> seen_;
};

/// What a box with this rig alone draws.
std::optional<hal::WarpPlan> planOf(const Rig& rig, const Seen& seen) {
  appliance::RigShelf shelf(rig);
  const appliance::RigPin pin = shelf.newest();
  appliance::ViewSet views(kZoom);
  views.update(pin, static_cast<std::uint32_t>(kScreen.width),
               static_cast<std::uint32_t>(kScreen.height), rig.target_m);
  return views.plan(pin, seen.camera, seen.plan.source);
}

bool sameLens(const hal::Lens& a, const hal::Lens& b) {
  return a.fx_px == b.fx_px && a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px &&
         a.distortion == b.distortion && a.max_radius == b.max_radius;
}

class RigSwap : public testing::Test {
 protected:
  void SetUp() override {
    for (std::uint64_t number = 0; number <= kSwaps; ++number) {
      texts_.push_back(calibration(number));
      auto rig = appliance::parseRig(texts_.back(), "calibration");
      ASSERT_TRUE(rig.has_value()) << rig.error();
      rigs_.push_back(std::move(*rig));
    }
    ASSERT_TRUE(emulator_.waitForOutput("ready", 30s)) << emulator_.output();
    std::ofstream(folder_ / "rig.toml") << texts_[0];
    const auto site = appliance::loadSite(
        KAGAMID_CONFIG,
        test::kagamidSettings(kNetwork, folder_.path(),
                              {"trigger.rate_hz=40", "cameras.packet_size_bytes=9000",
                               "state.trace=" + (folder_ / "trace.jsonl").string()}),
        {});
    ASSERT_TRUE(site.has_value()) << site.error();
    auto display = ui::OffscreenDisplay::create(
        {.renderer = {.width_px = static_cast<std::uint32_t>(kScreen.width),
                      .height_px = static_cast<std::uint32_t>(kScreen.height)},
         .refresh_hz = 80});
    ASSERT_TRUE(display.has_value()) << display.error();
    display_ = std::move(*display);
    watcher_ = std::make_unique<Watcher>(*display_);
    auto box = appliance::Box::start(*site, {.display = *display_, .observer = watcher_.get()});
    ASSERT_TRUE(box.has_value()) << box.error();
    box_ = std::move(*box);
    ASSERT_TRUE(test::becomesTrue([&] { return watcher_->focal_px > 0; }));
    std::this_thread::sleep_for(2s);  // the cameras find their pace, as in every report
  }

  /// As the control interface does it, and each view's turn.
  void swapRigs() {
    const rt::Timestamp begin = rt::now();
    for (std::uint64_t number = 1; number <= kSwaps; ++number) {
      rt::sleepUntil(begin + number * kBetweenSwaps);
      const auto loaded = box_->loadRig(texts_[number], "calibration");
      ASSERT_TRUE(loaded.has_value()) << "calibration " << number;
      if (number % 100 != 0) continue;
      const auto camera = static_cast<std::uint32_t>(number / 100) % rigs_[0].cameras.size();
      using Command = appliance::Command;
      (void)box_->command(
          {.kind = Command::Kind::kSetView, .camera = static_cast<std::uint32_t>(camera)});
    }
    EXPECT_TRUE(test::becomesTrue([&] { return numberOf(watcher_->focal_px) == kSwaps; }));
  }

  /// Which calibration has that focal length; more than kSwaps: none.
  [[nodiscard]] std::uint64_t numberOf(double fx_px) const {
    for (std::uint64_t number = kSwaps + 1; number-- > 0;) {
      if (std::ranges::any_of(rigs_[number].cameras,
                              [&](const auto& camera) { return camera.lens.fx_px == fx_px; }))
        return number;
    }
    return kSwaps + 1;
  }

  /// Whether everything in the picture is of the one calibration that its focal length names.
  void expectOneRig(const Seen& seen, std::uint64_t number) const {
    ASSERT_LE(number, kSwaps);
    const auto plan = planOf(rigs_[number], seen);
    ASSERT_TRUE(plan.has_value());
    EXPECT_TRUE(sameLens(seen.plan.lens, plan->lens));
    EXPECT_EQ(seen.plan.H_camera_display, plan->H_camera_display);
    EXPECT_EQ(seen.plan.colour, plan->colour);
    EXPECT_EQ(seen.plan.edge, plan->edge);
    EXPECT_EQ(seen.reddish, number % 2 == 0);
    ASSERT_TRUE(seen.stamp.has_value()) << "its stamp is not where this rig shows it";
    EXPECT_EQ(seen.stamp->camera, seen.camera);
    EXPECT_EQ(seen.stamp->trigger, seen.trigger);
  }

  /// Holds the run's trace against what the cameras say they sent. What this machine itself cost
  /// is counted apart, and so is a frame that an emulated camera, a program of this machine, too,
  /// did not send.
  void expectNoFrameLost() {
    emulator_.terminate();
    ASSERT_EQ(emulator_.wait(20s), 0) << emulator_.output();
    const auto trace = appliance::readTraceFile(folder_ / "trace.jsonl");
    ASSERT_TRUE(trace.has_value()) << trace.error();
    std::ifstream log(folder_ / "wire.csv");
    const auto sent = appliance::readWireLog(log, "wire.csv");
    ASSERT_TRUE(sent.has_value()) << sent.error();
    soak::LossAccount account(static_cast<std::uint32_t>(kNetwork.cameras), kPeriod);
    std::ranges::for_each(trace->triggers, [&](const auto& one) { account.triggerFired(one); });
    std::ranges::for_each(trace->frames, [&](const auto& one) { account.frameArrived(one); });
    std::ranges::for_each(*sent, [&](const auto& one) { account.frameSent(one); });
    account.finish(trace->summary->stop - 1s);
    const soak::Judgement judgement = soak::judge(account.lost(), {}, trace->stalls, kPeriod);
    std::uint64_t not_sent = 0;
    for (const soak::LostFrame& lost : judgement.unexplained) {
      if (lost.cause == soak::LossCause::kNotSent)
        ++not_sent;
      else
        ADD_FAILURE() << "lost: " << describe(lost, trace->run.start);
    }
    std::printf("%llu frames stored; %zu lost while this machine stood still, %llu not sent\n",
                static_cast<unsigned long long>(account.framesStored()),
                judgement.stood_still.size(), static_cast<unsigned long long>(not_sent));
    EXPECT_GT(account.framesStored(), 0U);
    EXPECT_TRUE(account.misattributed().empty());
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> texts_;  // of the calibrations
  std::vector<Rig> rigs_;           // the same, read
  test::ChildProcess emulator_{
      test::emulatorCommand(kNetwork, "640x480", folder_.path(),
                            {"--realtime-priority", "85", "--wire-log", folder_ / "wire.csv"}),
      folder_ / "emulator.log"};
  std::unique_ptr<ui::OffscreenDisplay> display_;
  std::unique_ptr<Watcher> watcher_;
  std::unique_ptr<appliance::Box> box_;
};

TEST_F(RigSwap, AThousandTimesUnderLoadMixesNoTwoRigsInAPictureAndLosesNoFrame) {
  ASSERT_NO_FATAL_FAILURE(swapRigs());
  const auto stopped = box_->stop();
  ASSERT_TRUE(stopped.has_value()) << stopped.error();

  std::set<std::uint64_t> numbers;
  std::set<std::uint32_t> cameras;
  std::uint64_t before = 0;
  for (const Seen& seen : watcher_->seen()) {
    const std::uint64_t number = numberOf(seen.plan.lens.fx_px);
    SCOPED_TRACE("camera " + std::to_string(seen.camera) + ", trigger " +
                 std::to_string(seen.trigger) + ", rig " + std::to_string(number));
    ASSERT_NO_FATAL_FAILURE(expectOneRig(seen, number));
    EXPECT_GE(number, before);
    before = number;
    numbers.insert(number);
    cameras.insert(seen.camera);
  }
  std::printf("%zu pictures of %zu rigs and %zu views\n", watcher_->seen().size(), numbers.size(),
              cameras.size());
  EXPECT_GT(numbers.size(), 50U);
  EXPECT_EQ(cameras.size(), rigs_[0].cameras.size());
  expectNoFrameLost();
}

}  // namespace
