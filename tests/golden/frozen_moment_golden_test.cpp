// The render loop with a true renderer: a moment that was frozen keeps every pixel of every view
// while capture goes ten times through the whole history.

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "appliance/capture/frame_history.h"
#include "appliance/geometry/rig.h"
#include "appliance/geometry/target_track.h"
#include "appliance/render/history_views.h"
#include "appliance/render/render_loop.h"
#include "ui-kms/offscreen_display.h"

namespace {

using namespace appliance;
using namespace std::chrono_literals;

constexpr std::uint32_t kCameras = 3;
constexpr std::uint32_t kSets = 8;
constexpr rt::Nanoseconds kPeriod = 5ms;
constexpr std::uint32_t kWidth = 160;
constexpr std::uint32_t kHeight = 128;
constexpr std::size_t kPictureBytes = std::size_t{320} * 180 * 4;

using Pixels = std::vector<std::byte>;

/// Level cameras, 4 m from the origin, which they look at.
Rig arc() {
  Rig rig;
  for (std::uint32_t i = 0; i < kCameras; ++i) {
    const double angle = 0.3 * i;
    const Eigen::Vector3d centre_m(4 * std::cos(angle), 4 * std::sin(angle), 0);
    RigCamera camera{.name = "cam" + std::to_string(i),
                     .width_px = kWidth,
                     .height_px = kHeight,
                     .lens = {.fx_px = 150,
                              .fy_px = 150,
                              .cx_px = (kWidth - 1) / 2.0,
                              .cy_px = (kHeight - 1) / 2.0,
                              .max_radius = 1}};
    const Eigen::Vector3d sight = -centre_m.normalized();
    const Eigen::Vector3d right = sight.cross(Eigen::Vector3d::UnitZ()).normalized();
    camera.R_cam_rig.row(0) = right;
    camera.R_cam_rig.row(1) = sight.cross(right);
    camera.R_cam_rig.row(2) = sight;
    camera.t_cam_rig_m = -(camera.R_cam_rig * centre_m);
    rig.cameras.push_back(camera);
  }
  fillReferences(rig);
  return rig;
}

/// Reads every picture back, on the render thread.
class PictureReader final : public PictureObserver {
 public:
  struct Picture {
    std::uint32_t camera;
    std::uint64_t trigger;
    std::uint64_t second_trigger;  // 0: none
    Mode mode;
    Pixels pixels;
  };

  explicit PictureReader(ui::PictureSource& source) : source_(source) {}

  void onPicture(const ShownPicture& shown) noexcept override {
    Picture picture{.camera = shown.record.camera_shown,
                    .trigger = shown.record.trigger,
                    .second_trigger = shown.record.second.trigger,
                    .mode = shown.record.mode,
                    .pixels = Pixels(kPictureBytes)};
    if (!source_.readPicture(picture.pixels)) return;
    const std::scoped_lock lock(mutex_);
    pictures_.push_back(std::move(picture));
  }

  /// Takes what came, until a picture is @p wanted.
  std::vector<Picture> until(const std::function<bool(const Picture&)>& wanted) {
    std::vector<Picture> seen;
    const rt::Timestamp patience = rt::now() + 30s;
    while (rt::now() < patience) {
      {
        const std::scoped_lock lock(mutex_);
        for (; !pictures_.empty(); pictures_.pop_front()) {
          seen.push_back(std::move(pictures_.front()));
        }
      }
      if (std::ranges::any_of(seen, wanted)) return seen;
      std::this_thread::sleep_for(2ms);
    }
    ADD_FAILURE() << "the picture did not come";
    return seen;
  }

 private:
  ui::PictureSource& source_;
  std::mutex mutex_;
  std::deque<Picture> pictures_;
};

/// A box without cameras: the test stores their frames.
class FrozenBox : public testing::Test {
 protected:
  void SetUp() override {
    ui::OffscreenConfig config;
    config.renderer.width_px = 320;
    config.renderer.height_px = 180;
    config.renderer.sources = {{kWidth, kHeight}};
    config.refresh_hz = 200;
    auto display = ui::OffscreenDisplay::create(config);
    ASSERT_TRUE(display) << display.error();
    display_ = std::move(*display);
    auto history = FrameHistory::create(
        {.frame_bytes = std::vector<std::size_t>(kCameras, std::size_t{kWidth} * kHeight),
         .sets = kSets,
         .in_flight = 2,
         .reserve = RenderLoop::kPinsPerCamera});
    ASSERT_TRUE(history) << history.error();
    history_ = std::move(*history);
    frames_ = std::make_unique<HistoryViews>(
        **history_->openReader("render", RenderLoop::kPinsPerCamera), board_.edges);
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      slots_.push_back(history_->camera(i).fillingSlots()[0]);
    }
    reader_ = std::make_unique<PictureReader>(*display_);
    loop_ = std::make_unique<RenderLoop>(RenderParts{.rigs = rigs_,
                                                     .frames = *frames_,
                                                     .board = board_,
                                                     .commands = commands_,
                                                     .shown = shown_,
                                                     .target = target_,
                                                     .display = *display_,
                                                     .overlay = *overlay_,
                                                     .trace = nullptr,
                                                     .observer = reader_.get()},
                                         RenderParameters{.trigger_period = kPeriod});
    thread_ = std::jthread([this](const std::stop_token& stop) { loop_->run(stop); });
  }
  void TearDown() override {
    thread_ = {};
    for (const ReaderReport& reader : history_->readers()) EXPECT_EQ(reader.refused, 0U);
  }

  /// The next trigger: every camera delivers a frame that no other moment or camera has.
  void capture() {
    ++trigger_;
    board_.edges.post(trigger_, rt::now());
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      std::uint32_t noise = static_cast<std::uint32_t>(trigger_ * 31 + camera * 7 + 1);
      for (std::byte& pixel : history_->camera(camera).slots()[slots_[camera]]) {
        noise = noise * 1664525 + 1013904223;
        pixel = static_cast<std::byte>(noise >> 24);
      }
      slots_[camera] = history_->camera(camera).store(
          slots_[camera], {.trigger = trigger_, .trigger_edge = board_.edges.edge(trigger_)});
    }
    board_.wake_render.ring();
  }
  void press(const Command& command) { ASSERT_TRUE(coach_.give({command, rt::now()})); }

  /// Freezes the sixth moment, which is shown, and looks at it while capture goes ten times through
  /// the history.
  void expectEveryPixelKept() {
    press({.kind = Command::Kind::kFreezeToggle});
    std::map<std::uint32_t, Pixels> views;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      press({.kind = Command::Kind::kSetView, .camera = camera});
      const auto seen = reader_->until([camera](const auto& picture) {
        return picture.camera == camera && picture.mode == Mode::kFrozen;
      });
      ASSERT_EQ(seen.back().trigger, 6U);
      views[camera] = seen.back().pixels;
    }
    ASSERT_NE(views[0], views[1]);

    std::size_t compared = 0;
    for (std::uint32_t round = 0; round < 10; ++round) {
      for (std::uint32_t i = 0; i < kSets; ++i) capture();
      const std::uint32_t camera = round % kCameras;
      press({.kind = Command::Kind::kSetView, .camera = camera});
      const auto seen =
          reader_->until([camera](const auto& picture) { return picture.camera == camera; });
      for (const auto& picture : seen) {
        ASSERT_EQ(picture.trigger, 6U);
        ASSERT_EQ(picture.mode, Mode::kFrozen);
        ASSERT_TRUE(picture.pixels == views[picture.camera]) << "camera " << picture.camera;
        ++compared;
      }
    }
    EXPECT_GE(compared, 10U);
  }

  RigShelf rigs_{arc()};
  CaptureBoard board_{kCameras};
  CommandInbox commands_{board_.wake_render};
  CommandSender& coach_ = commands_.open("coach");
  ShownBoard shown_;
  const TargetTrack target_;
  // Without an overlay: the status line changes, all else must not.
  std::unique_ptr<OverlayBoard> overlay_ = std::make_unique<OverlayBoard>();
  std::unique_ptr<ui::OffscreenDisplay> display_;
  std::unique_ptr<FrameHistory> history_;
  std::unique_ptr<HistoryViews> frames_;
  std::vector<std::uint32_t> slots_;
  std::unique_ptr<PictureReader> reader_;
  std::unique_ptr<RenderLoop> loop_;
  std::uint64_t trigger_ = 0;
  std::jthread thread_;
};

TEST_F(FrozenBox, KeepsEveryPixelOfEveryViewForTenTimesTheHistory) {
  for (int i = 0; i < 6; ++i) capture();
  (void)reader_->until([](const auto& picture) { return picture.trigger == 6; });
  expectEveryPixelKept();
  press({.kind = Command::Kind::kGoLive});
  capture();
  const auto live =
      reader_->until([this](const auto& picture) { return picture.trigger == trigger_; });
  EXPECT_EQ(live.back().mode, Mode::kLive);
}

TEST_F(FrozenBox, KeepsBothMomentsOfAComparison) {
  for (int i = 0; i < 6; ++i) capture();
  const auto alone =
      reader_->until([](const auto& picture) { return picture.trigger == 6; }).back();
  press({.kind = Command::Kind::kCompare,
         .camera = Command::kSameView,
         .delay = 2 * kPeriod,
         .composition = {.layout = Layout::kSideBySide}});
  const auto both =
      reader_->until([](const auto& picture) { return picture.second_trigger == 4; }).back();
  EXPECT_NE(both.pixels, alone.pixels);
  expectEveryPixelKept();
}

}  // namespace
