#include "appliance/render/render_loop.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "appliance/geometry/rig.h"
#include "appliance/geometry/target_track.h"

namespace {

using namespace appliance;
using namespace std::chrono_literals;

/// A memory in which no frame ever arrived: the picture is an empty one.
class NoFrames final : public StoredFrames {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 1; }
  [[nodiscard]] StoredRange range(std::uint32_t /*camera*/) const noexcept override { return {}; }
  [[nodiscard]] bool holds(std::uint32_t /*camera*/,
                           std::uint64_t /*trigger*/) const noexcept override {
    return false;
  }
  [[nodiscard]] bool living(std::uint32_t /*camera*/) const noexcept override { return true; }
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t /*camera*/,
                                                  std::uint64_t /*trigger*/) noexcept override {
    return std::nullopt;
  }
};

/// A screen that is always there.
class TestDisplay : public hal::Display {
 public:
  [[nodiscard]] hal::DisplayMode mode() const override { return {320, 180, 60}; }
  [[nodiscard]] std::string_view renderer() const override { return "a test"; }
  [[nodiscard]] std::string_view uploadReason() const override { return {}; }
  [[nodiscard]] hal::Typesetter* typesetter() override { return nullptr; }
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override { return std::nullopt; }
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override { return std::nullopt; }
  [[nodiscard]] hal::ScreenStatus screen() const override { return {}; }
  void releaseScreen() override {}
  void takeScreen() override {}
  void detach() override {}
};

/// Draws for 2 ms and then refuses every picture.
class RefusingDisplay final : public TestDisplay {
 public:
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& /*scene*/) override {
    const rt::Timestamp begin = rt::now();
    while (rt::now() < begin + 2ms) {
    }
    const std::int64_t took_ns = (rt::now() - begin).count();
    drawing_ns_ += took_ns;
    longest_ns_ = std::max(longest_ns_.load(), took_ns);
    ++pictures_;
    return hal::RenderInstants{};
  }
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t /*picture_id*/) override {
    return std::unexpected(rt::Error{.code = rt::Errc::kBusy, .where = "commit"});
  }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override { return rt::now(); }

  [[nodiscard]] rt::Nanoseconds drawing() const { return rt::Nanoseconds(drawing_ns_.load()); }
  [[nodiscard]] rt::Nanoseconds longest() const { return rt::Nanoseconds(longest_ns_.load()); }
  [[nodiscard]] int pictures() const { return pictures_; }

 private:
  std::atomic<std::int64_t> drawing_ns_ = 0;
  std::atomic<std::int64_t> longest_ns_ = 0;
  std::atomic<int> pictures_ = 0;
};

/// Takes every picture and notes its overlay.
class NotingDisplay final : public TestDisplay {
 public:
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& scene) override {
    overlay_ = scene.overlay->generation;
    return hal::RenderInstants{};
  }
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t /*picture_id*/) override {
    ++pictures_;
    return rt::now();
  }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override { return std::nullopt; }

  [[nodiscard]] std::uint64_t overlay() const { return overlay_; }
  [[nodiscard]] int pictures() const { return pictures_; }

 private:
  std::atomic<std::uint64_t> overlay_ = 0;
  std::atomic<int> pictures_ = 0;
};

/// What a render loop without frames works with.
struct Bench {
  explicit Bench(hal::Display& screen) : display(screen) {}
  [[nodiscard]] RenderParts parts() {
    return {.rigs = rigs,
            .frames = frames,
            .board = board,
            .commands = commands,
            .shown = shown,
            .target = target,
            .display = display,
            .overlay = *overlay,
            .trace = nullptr,
            .observer = nullptr};
  }

  hal::Display& display;
  RigShelf rigs{Rig{.cameras = {{.name = "only", .width_px = 64, .height_px = 64}}}};
  NoFrames frames;
  CaptureBoard board{1};
  CommandInbox commands{board.wake_render};
  ShownBoard shown;
  TargetTrack target;
  std::unique_ptr<OverlayBoard> overlay = std::make_unique<OverlayBoard>();
};

TEST(RenderLoop, SpendsItsAllowanceOnPicturesThatTheDisplayRefuses) {
  RefusingDisplay display;
  Bench bench(display);
  constexpr rt::Nanoseconds kPeriod = 10ms;
  RenderLoop loop(bench.parts(), {.trigger_period = kPeriod});
  const rt::Timestamp begin = rt::now();
  {
    const std::jthread render([&loop](const std::stop_token& stop) { loop.run(stop); });
    while (display.pictures() < 100) std::this_thread::sleep_for(1ms);
  }
  // At most 60 % of the time and of a burst of a period, and a picture that began just before.
  const rt::Nanoseconds passed = rt::now() - begin;
  EXPECT_LE(display.drawing(), (passed + kPeriod) * 6 / 10 + display.longest());
}

TEST(RenderLoop, SaysWhatItShowsAndGivesANewOverlayAPictureOfItsOwn) {
  NotingDisplay display;
  Bench bench(display);
  RenderLoop loop(bench.parts(), {.trigger_period = 5ms});
  const std::jthread render([&loop](const std::stop_token& stop) { loop.run(stop); });
  EXPECT_TRUE(bench.overlay->subject_changed.waitUntil(rt::now() + 20s));
  const OverlaySubject subject = bench.overlay->subject.latest();
  EXPECT_EQ(subject.cameras, 1U);
  EXPECT_EQ(subject.width_px, 320U);
  EXPECT_EQ(subject.height_px, 180U);

  const auto overlay = std::make_unique<hal::Overlay>();
  for (std::uint64_t generation = 1; generation <= 3; ++generation) {
    overlay->generation = generation;
    bench.overlay->overlay.publish(*overlay);
    const rt::Timestamp patience = rt::now() + 20s;
    while (display.overlay() != generation && rt::now() < patience) {
      std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(display.overlay(), generation);
  }
  // Nothing changes any more: nothing is drawn any more.
  const int pictures = display.pictures();
  std::this_thread::sleep_for(50ms);
  EXPECT_LE(display.pictures(), pictures + 1);
}

}  // namespace
