// What every backend of hal::Camera must do. A backend takes part by one line at the end: how to
// open a camera that fires on the given trigger.

#include "hal/camera.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/aravis/aravis_camera.h"
#include "hal/aravis/camera_probe.h"
#include "hal/emulated/trigger_line.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kWidth = 640;
constexpr std::uint32_t kHeight = 480;
constexpr std::uint32_t kSlots = 6;

/// A camera under test and the hardware it needs.
class CameraRig {
 public:
  virtual ~CameraRig() = default;
  virtual std::expected<std::unique_ptr<hal::Camera>, std::string> open(
      const hal::CameraProfile& profile) = 0;
  virtual hal::CameraProbe probe() = 0;
  virtual std::string address() const = 0;
  virtual void fire() = 0;
};

/// Keeps what a camera delivers; slots go round in order of arrival.
class Recorder final : public hal::FrameSink {
 public:
  std::uint32_t onFrame(const hal::FrameArrival& arrival) noexcept override {
    const std::scoped_lock lock(mutex_);
    arrivals_.push_back(arrival);
    free_.push_back(arrival.slot);
    const std::uint32_t next = free_.front();
    free_.erase(free_.begin());
    return next;
  }
  std::vector<hal::FrameArrival> arrivals() {
    const std::scoped_lock lock(mutex_);
    return arrivals_;
  }
  bool waitFor(std::size_t count) {
    for (int i = 0; i < 500 && arrivals().size() < count; ++i) std::this_thread::sleep_for(10ms);
    return arrivals().size() >= count;
  }

 private:
  std::mutex mutex_;
  std::vector<hal::FrameArrival> arrivals_;
  std::vector<std::uint32_t> free_{4, 5};  // 0 to 3 are in the camera's hands
};

using MakeRig = std::function<std::unique_ptr<CameraRig>()>;

class CameraConformance : public testing::TestWithParam<MakeRig> {
 protected:
  void SetUp() override {
    rig_ = GetParam()();
    for (std::uint32_t i = 0; i < kSlots; ++i) {
      memory_.emplace_back(std::size_t{kWidth} * kHeight);
      slots_.emplace_back(memory_.back());
    }
  }
  hal::CameraProfile profile() const {
    return {.name = "cam01",
            .address = rig_->address(),
            .width_px = kWidth,
            .height_px = kHeight,
            .packet_size_bytes = 1500};
  }
  std::unique_ptr<hal::Camera> opened() {
    auto camera = rig_->open(profile());
    if (!camera) {
      ADD_FAILURE() << camera.error();
      return nullptr;
    }
    return std::move(*camera);
  }
  void fireAndWait(Recorder& recorder, std::size_t frames) {
    for (std::size_t i = 0; i < frames; ++i) {
      const std::size_t before = recorder.arrivals().size();
      rig_->fire();
      ASSERT_TRUE(recorder.waitFor(before + 1)) << "trigger " << i + 1 << " delivered no frame";
    }
  }

  std::unique_ptr<CameraRig> rig_;
  std::vector<std::vector<std::byte>> memory_;
  std::vector<std::span<std::byte>> slots_;
  const std::vector<std::uint32_t> first_slots_{0, 1, 2, 3};
};

TEST_P(CameraConformance, DeliversOneCompleteFramePerTriggerInOrder) {
  const auto camera = opened();
  ASSERT_TRUE(camera);
  Recorder recorder;
  ASSERT_TRUE(camera->start(recorder, slots_, first_slots_));
  fireAndWait(recorder, 10);
  camera->stop();

  const auto arrivals = recorder.arrivals();
  ASSERT_EQ(arrivals.size(), 10U);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    EXPECT_EQ(arrivals[i].status, hal::FrameStatus::kComplete);
    EXPECT_LE(arrivals[i].first_packet, arrivals[i].last_packet);
    if (i > 0) {
      EXPECT_EQ(arrivals[i].frame_id, arrivals[i - 1].frame_id + 1);
    }
  }
  EXPECT_EQ(camera->statistics().frames_incomplete, 0U);
}

TEST_P(CameraConformance, FillsTheSlotsThatTheSinkNames) {
  const auto camera = opened();
  ASSERT_TRUE(camera);
  Recorder recorder;
  ASSERT_TRUE(camera->start(recorder, slots_, first_slots_));
  fireAndWait(recorder, 8);
  camera->stop();

  std::vector<std::uint32_t> order;
  for (const auto& arrival : recorder.arrivals()) order.push_back(arrival.slot);
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3, 4, 5, 0, 1));
  for (const auto& memory : memory_) {
    const std::set<std::byte> values(memory.begin(), memory.end());
    EXPECT_GT(values.size(), 1U) << "a delivered slot holds no picture";
  }
}

TEST_P(CameraConformance, IsSilentWithoutTriggers) {
  const auto camera = opened();
  ASSERT_TRUE(camera);
  Recorder recorder;
  ASSERT_TRUE(camera->start(recorder, slots_, first_slots_));
  std::this_thread::sleep_for(200ms);  // several frames' time for a camera that runs free
  EXPECT_TRUE(recorder.arrivals().empty());
  camera->stop();
}

TEST_P(CameraConformance, DeliversNothingAfterStopAndStartsAgain) {
  const auto camera = opened();
  ASSERT_TRUE(camera);
  Recorder first;
  ASSERT_TRUE(camera->start(first, slots_, first_slots_));
  fireAndWait(first, 2);
  camera->stop();
  camera->stop();
  const std::size_t delivered = first.arrivals().size();
  rig_->fire();
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(first.arrivals().size(), delivered);

  Recorder second;
  ASSERT_TRUE(camera->start(second, slots_, first_slots_));
  fireAndWait(second, 2);
  camera->stop();
  EXPECT_EQ(second.arrivals().size(), 2U);
}

TEST_P(CameraConformance, TellsAProbeWhetherItIsFreeOrOurs) {
  EXPECT_EQ(rig_->probe().answer, hal::CameraAnswer::kFree);
  auto camera = opened();
  ASSERT_TRUE(camera);
  EXPECT_EQ(rig_->probe().answer, hal::CameraAnswer::kOurs);
  camera.reset();
  EXPECT_EQ(rig_->probe().answer, hal::CameraAnswer::kFree);
}

TEST_P(CameraConformance, IsRefusedWhileSomebodyElseControlsIt) {
  const auto camera = opened();
  ASSERT_TRUE(camera);
  const auto second = rig_->open(profile());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error(), testing::HasSubstr("another program controls it"));
  Recorder recorder;
  ASSERT_TRUE(camera->start(recorder, slots_, first_slots_)) << "the first lost it by that";
  fireAndWait(recorder, 2);
}

TEST_P(CameraConformance, NamesTheCameraAndTheAddressThatDoesNotAnswer) {
  hal::CameraProfile absent = profile();
  absent.address = "127.0.3.99";
  const auto camera = rig_->open(absent);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), testing::HasSubstr("cam01 (127.0.3.99)"));
}

TEST_P(CameraConformance, RefusesASizeThatTheSensorDoesNotHave) {
  hal::CameraProfile huge = profile();
  huge.width_px = 4096;
  huge.height_px = 4096;
  const auto camera = rig_->open(huge);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), testing::HasSubstr("Width"));
}

/// The Aravis backend, against one emulated GigE Vision camera.
class EmulatedGigE final : public CameraRig {
 public:
  EmulatedGigE()
      : emulator_({KAGAMI_EMULATOR, "--cameras", "1", "--size", "640x480", "--first-address",
                   "127.0.3.1", "--wire-port", "3993"},
                  folder_ / "emulator.log") {
    if (!emulator_.waitForOutput("ready", 20s)) {
      ADD_FAILURE() << "the emulator does not start: " << emulator_.output();
      return;
    }
    auto line = hal::emulated::EmulatedTriggerLine::open(3993);
    if (line) line_ = std::move(*line);
  }
  std::expected<std::unique_ptr<hal::Camera>, std::string> open(
      const hal::CameraProfile& profile) override {
    return hal::aravis::openCamera(profile, {.name = "recv01"});
  }
  hal::CameraProbe probe() override { return hal::aravis::probeCamera(address(), 10s); }
  std::string address() const override { return "127.0.3.1"; }
  void fire() override {
    ASSERT_TRUE(line_);
    EXPECT_TRUE(line_->setActive(true));
    EXPECT_TRUE(line_->setActive(false));
  }

 private:
  test::TemporaryFolder folder_;
  test::ChildProcess emulator_;
  std::unique_ptr<hal::TriggerLine> line_;
};

INSTANTIATE_TEST_SUITE_P(Aravis, CameraConformance,
                         testing::Values(MakeRig{[] { return std::make_unique<EmulatedGigE>(); }}),
                         [](const auto& /*rig*/) { return "EmulatedGigE"; });

}  // namespace
