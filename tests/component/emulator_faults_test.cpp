// Faults of the emulator, given on command, as its clients see them.
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>

#include <arv.h>
#include <gtest/gtest.h>

#include "hal/emulated/rig/features.h"
#include "tests/component/bare_client.h"
#include "tests/component/emulator_fixture.h"
#include "tests/support/fault_port.h"

namespace {

using namespace std::chrono_literals;
using test::BareClient;
using test::BufferPointer;
using test::CameraPointer;
using test::EmulatorTest;
using test::Failure;
using test::kAddress;
using test::kHeight;
using test::open;
using test::pushProfile;
using test::readStamp;
using test::StreamPointer;

/// Faults on command at a camera that streams; what comes of them is seen from outside.
class EmulatorFaultTest : public EmulatorTest {
 protected:
  void SetUp() override {
    start({"--fault-log", folder_ / "faults.csv"});
    std::string error;
    camera_ = open(error);
    ASSERT_TRUE(camera_) << error;
    ASSERT_EQ(pushProfile(camera_.get()), "");
    stream_ = startStream(camera_.get());
    ASSERT_TRUE(stream_);
  }
  void TearDown() override {
    stream_.reset();
    camera_.reset();
  }
  static void fault(const std::string& text) {
    EXPECT_EQ(test::sendFault(kAddress, 3991, "1 " + text), "ok") << text;
  }
  /// The next frame, whole; null when none comes.
  BufferPointer frame(std::chrono::microseconds patience = 10s) {
    BufferPointer buffer(
        arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(patience.count())));
    if (buffer) {
      arv_stream_push_buffer(stream_.get(), ARV_BUFFER(g_object_ref(buffer.get())));
    }
    return buffer;
  }
  void expectFrameOf(std::uint32_t trigger) {
    const BufferPointer buffer = frame();
    ASSERT_TRUE(buffer) << trigger;
    const auto stamp = readStamp(buffer.get());
    ASSERT_TRUE(stamp) << trigger;
    EXPECT_EQ(stamp->trigger, trigger);
  }
  std::string faultLog() {
    std::ifstream file(folder_ / "faults.csv");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  CameraPointer camera_;
  StreamPointer stream_;
};

TEST_F(EmulatorFaultTest, PassesOverEdgesWithoutUsingUpIds) {
  pulse();
  const BufferPointer first = frame();
  ASSERT_TRUE(first);
  const guint64 id = arv_buffer_get_frame_id(first.get());
  fault("ignore-triggers 2");
  for (int i = 0; i < 2; ++i) pulse();
  EXPECT_FALSE(frame(300ms));
  pulse();
  const BufferPointer next = frame();
  ASSERT_TRUE(next);
  EXPECT_EQ(arv_buffer_get_frame_id(next.get()), id + 1);
  EXPECT_EQ(readStamp(next.get())->trigger, 4U);
  TearDown();
  const auto stats = stop();
  EXPECT_EQ(stats["overtriggers"], 0);
  EXPECT_EQ(stats["frames_withheld_on_purpose"], 2);
  EXPECT_NE(faultLog().find(",1,ignore-triggers 2\n"), std::string::npos) << faultLog();
  EXPECT_NE(faultLog().find(",1,effect ignore-triggers trigger 3\n"), std::string::npos);
}

TEST_F(EmulatorFaultTest, SendsAFrameThatNothingAskedFor) {
  fault("extra-frame");
  expectFrameOf(0);
  pulse();
  expectFrameOf(1);
}

TEST_F(EmulatorFaultTest, WrapsItsIdsWhereTold) {
  fault("frame-id 65535");
  pulse();
  const BufferPointer last = frame();
  ASSERT_TRUE(last);
  EXPECT_EQ(arv_buffer_get_frame_id(last.get()), 65'535U);
  pulse();
  const BufferPointer next = frame();
  ASSERT_TRUE(next);
  EXPECT_EQ(arv_buffer_get_frame_id(next.get()), 1U);
}

TEST_F(EmulatorFaultTest, SendsHalfAFrameAndThenWholeOnesAgain) {
  fault("wrong-size on");
  pulse();
  const BufferPointer half = frame();
  ASSERT_TRUE(half);
  EXPECT_EQ(arv_buffer_get_image_height(half.get()), kHeight / 2);
  fault("clear");
  pulse();
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, HoldsAFrameBackAndTheNextBehindIt) {
  fault("late-leader 2000");
  pulse();
  EXPECT_FALSE(frame(100ms));
  pulse();
  expectFrameOf(1);
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, FrozenAnswersButSendsNothing) {
  fault("freeze");
  pulse();
  EXPECT_FALSE(frame(300ms));
  Failure f;
  EXPECT_STREQ(arv_camera_get_string(camera_.get(), "TriggerMode", &f), "On");
  fault("thaw");
  pulse();
  expectFrameOf(2);
}

TEST_F(EmulatorFaultTest, UnpluggedKeepsItsSettingsAndItsController) {
  fault("kill");
  pulse();
  EXPECT_FALSE(frame(300ms));
  fault("revive");
  pulse();
  expectFrameOf(2);
  TearDown();
  EXPECT_EQ(stop()["frames_sent"], 1);
  EXPECT_EQ(wireLogLines(), 2U) << "a frame of which no packet left is not in the wire log";
  EXPECT_NE(faultLog().find("effect kill trigger 1 frame 1 packets "), std::string::npos)
      << faultLog();
}

TEST_F(EmulatorFaultTest, WakesUpFromARebootWithItsDefaultsAndWithoutAController) {
  fault("reboot 0.2");
  BareClient client(kAddress);
  std::optional<std::uint16_t> status;
  for (int i = 0; i < 100 && !status; ++i) {
    status = client.write(emulator::reg::kControlPrivilege, 2);
  }
  EXPECT_EQ(status, 0);
  EXPECT_EQ(client.write(emulator::reg::kExposureTime, 0x447a0000), 0x8004)
      << "automatic, as switched on";
}

TEST_F(EmulatorFaultTest, TellsASlowerLink) {
  Failure f;
  EXPECT_EQ(arv_camera_get_integer(camera_.get(), "GevLinkSpeed", &f), 1000);
  fault("link 100");
  EXPECT_EQ(arv_camera_get_integer(camera_.get(), "GevLinkSpeed", &f), 100);
  EXPECT_EQ(f.text(), "");
}

TEST_F(EmulatorFaultTest, DeliversThroughAWireThatReordersAndDoublesPackets) {
  fault("reorder 30");
  fault("duplicate 30");
  expectPicturePerPulse(stream_.get(), 10);
  TearDown();
  const auto stats = stop();
  EXPECT_GT(stats["packets_overtaken"], 0);
  EXPECT_GT(stats["packets_doubled"], 0);
}

TEST_F(EmulatorFaultTest, LosesLargeDatagramsOnAPathThatDoesNotCarryThem) {
  fault("mtu 1500");
  pulse();
  BufferPointer buffer = frame(1s);
  if (!buffer) {
    pulse();  // newer Aravis waits for the payload of a leader until a later frame begins
    buffer = frame();
  }
  ASSERT_TRUE(buffer);
  EXPECT_NE(arv_buffer_get_status(buffer.get()), ARV_BUFFER_STATUS_SUCCESS);
  TearDown();
  (void)stop();
  EXPECT_NE(faultLog().find("effect mtu trigger 1 frame 1 packets "), std::string::npos)
      << faultLog();
}

}  // namespace
