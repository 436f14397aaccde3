#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/render/render_loop.h"
#include "rt/pin_budget.h"

namespace {

using namespace appliance;
using namespace std::chrono_literals;

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 180;
constexpr double kZoom = 1.25;

/// A rig whose every number says which one it is.
Rig rigOf(std::uint64_t mark) {
  const auto number = static_cast<double>(mark);
  Rig rig;
  rig.target_m = {0, 0, 1};
  for (int i = 0; i < 3; ++i) {
    RigCamera camera{.name = "cam" + std::to_string(i + 1), .width_px = 64, .height_px = 48};
    camera.lens = {
        .fx_px = 60 + number / 100, .fy_px = 60, .cx_px = 31.5, .cy_px = 23.5, .max_radius = 10};
    camera.colour.black_level = static_cast<float>(mark % 100);
    camera.R_cam_rig << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    camera.t_cam_rig_m = {0.1 * i, 1, 4 + number / 1000};
    rig.cameras.push_back(std::move(camera));
  }
  fillReferences(rig);
  return rig;
}

/// Every camera has the newest frame, always.
class EveryFrame final : public StoredFrames {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 3; }
  [[nodiscard]] StoredRange range(std::uint32_t /*camera*/) const noexcept override {
    return {.oldest = 1, .newest = newest.load()};
  }
  [[nodiscard]] bool holds(std::uint32_t /*camera*/,
                           std::uint64_t trigger) const noexcept override {
    return trigger >= 1 && trigger <= newest.load();
  }
  [[nodiscard]] bool living(std::uint32_t /*camera*/) const noexcept override { return true; }
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                  std::uint64_t trigger) noexcept override {
    if (!holds(camera, trigger) || !budget_.trySpend()) return std::nullopt;
    return PinnedFrame{.pin = FramePin(rt::SlotPin{}, budget_),
                       .pixels = pixels_.data(),
                       .frame = {.trigger = trigger}};
  }

  std::atomic<std::uint64_t> newest{1};

 private:
  std::vector<std::byte> pixels_ = std::vector<std::byte>(std::size_t{64} * 48);
  rt::PinBudget budget_{100};
};

/// Holds every plan against the one rig that it can be of.
class CheckingDisplay final : public hal::Display {
 public:
  [[nodiscard]] hal::DisplayMode mode() const override { return {kWidth, kHeight, 60}; }
  [[nodiscard]] std::string_view renderer() const override { return "a test"; }
  [[nodiscard]] std::string_view uploadReason() const override { return {}; }
  [[nodiscard]] hal::Typesetter* typesetter() override { return nullptr; }
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& scene) override {
    if (scene.count == 1) check(scene.layers[0].plan);
    return hal::RenderInstants{};
  }
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t /*picture_id*/) override {
    ++pictures;
    return rt::now();
  }
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override { return std::nullopt; }
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override { return std::nullopt; }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override { return std::nullopt; }
  [[nodiscard]] hal::ScreenStatus screen() const override { return {}; }
  void releaseScreen() override {}
  void takeScreen() override {}
  void detach() override {}

  std::atomic<int> pictures = 0;
  std::atomic<int> mixed = 0;
  std::atomic<std::uint64_t> last_mark = 0;

 private:
  void check(const hal::WarpPlan& plan) {
    const auto mark = static_cast<std::uint64_t>(std::lround((plan.lens.fx_px - 60) * 100));
    const Rig rig = rigOf(mark);
    bool one = false;
    for (const RigCamera& camera : rig.cameras) {
      const View view = viewOf(camera, rig, rig.target_m,
                               {.width_px = kWidth, .height_px = kHeight, .zoom = kZoom});
      one = one || (view.H_camera_display == plan.H_camera_display && camera.colour == plan.colour);
    }
    if (!one || mark < last_mark) ++mixed;
    last_mark = mark;
  }
};

TEST(RigSwap, NeverMixesTwoRigsInAPictureAndLosesNone) {
  constexpr std::uint64_t kSwaps = 1000;
  RigShelf rigs(rigOf(1));
  EveryFrame frames;
  CaptureBoard board(3);
  CommandInbox commands(board.wake_render);
  ShownBoard shown;
  const TargetTrack target;
  const auto overlay = std::make_unique<OverlayBoard>();
  CheckingDisplay display;
  RenderLoop loop({.rigs = rigs,
                   .frames = frames,
                   .board = board,
                   .commands = commands,
                   .shown = shown,
                   .target = target,
                   .display = display,
                   .overlay = *overlay,
                   .trace = nullptr,
                   .observer = nullptr},
                  {.trigger_period = 1ms, .zoom = kZoom});
  {
    const std::jthread render([&loop](const std::stop_token& stop) { loop.run(stop); });
    for (std::uint64_t mark = 2; mark <= kSwaps; ++mark) {
      ASSERT_EQ(rigs.put(rigOf(mark)), mark);
      ++frames.newest;
      board.wake_render.ring();
      // Ten swaps a picture at most: load, not silence.
      while (mark % 10 == 0 && display.pictures < static_cast<int>(mark / 10))
        std::this_thread::yield();
    }
    while (display.last_mark < kSwaps) std::this_thread::yield();
  }
  EXPECT_EQ(display.mixed, 0);
  EXPECT_GE(display.pictures, 100);
  EXPECT_EQ(loop.metrics().skipped.value(), 0u);
}

}  // namespace
