#include <array>
#include <bit>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/emulated/rig/control_channel.h"
#include "hal/emulated/rig/device_xml.h"
#include "hal/emulated/rig/features.h"
#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/registers.h"
#include "hal/emulated/rig/run_record.h"
#include "hal/emulated/rig/trigger_wire.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;
using gvcp::Status;

const std::string kXml = makeDeviceXml(9000);

Registers powerOn() {
  return Registers(
      {.number = 2, .address = 0x7f000003, .user_name = "cam03", .sensor = {1280, 1024}}, 9000,
      kXml);
}

TEST(Registers, WakeUpUnlikeWhatAnApplianceWants) {
  const Registers registers = powerOn();
  EXPECT_EQ(registers.get(reg::kPixelFormat), gvsp::kPixelMono8);
  EXPECT_EQ(registers.get(reg::kTriggerMode), 0u);
  EXPECT_NE(registers.get(reg::kExposureAuto), 0u);
  EXPECT_NE(registers.get(reg::kGainAuto), 0u);
  EXPECT_NE(registers.get(reg::kBalanceAuto), 0u);
}

TEST(Registers, RefuseAManualValueWhileTheAutoFunctionRuns) {
  Registers registers = powerOn();
  const auto millisecond = std::bit_cast<std::uint32_t>(1000.0f);
  EXPECT_EQ(registers.checkWrite(reg::kExposureTime, millisecond, false), Status::kWriteProtect);
  registers.set(reg::kExposureAuto, 0);
  EXPECT_EQ(registers.checkWrite(reg::kExposureTime, millisecond, false), Status::kSuccess);
}

TEST(Registers, RefuseValuesOutOfRangeAndOffStep) {
  Registers registers = powerOn();
  registers.set(reg::kExposureAuto, 0);
  const auto too_short = std::bit_cast<std::uint32_t>(1.0f);
  EXPECT_EQ(registers.checkWrite(reg::kExposureTime, too_short, false), Status::kInvalidParameter);
  const auto nan = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(registers.checkWrite(reg::kExposureTime, nan, false), Status::kInvalidParameter);
  EXPECT_EQ(registers.checkWrite(reg::kWidth, 1279, false), Status::kInvalidParameter);
  EXPECT_EQ(registers.checkWrite(reg::kPixelFormat, 12345, false), Status::kInvalidParameter);
  EXPECT_EQ(registers.checkWrite(reg::kStreamPacketSize, 9004, false), Status::kInvalidParameter);
}

TEST(Registers, KeepTheRegionInsideTheSensor) {
  Registers registers = powerOn();
  EXPECT_EQ(registers.checkWrite(reg::kOffsetX, 2, false), Status::kInvalidParameter);
  registers.set(reg::kWidth, 640);
  EXPECT_EQ(registers.checkWrite(reg::kOffsetX, 640, false), Status::kSuccess);
  EXPECT_EQ(registers.checkWrite(reg::kOffsetX, 642, false), Status::kInvalidParameter);
}

TEST(Registers, HoldThePictureStillWhileAcquiring) {
  const Registers registers = powerOn();
  EXPECT_EQ(registers.checkWrite(reg::kWidth, 640, true), Status::kBusy);
  EXPECT_EQ(registers.checkWrite(reg::kPixelFormat, gvsp::kPixelBayerRG8, true), Status::kBusy);
  EXPECT_EQ(registers.checkWrite(reg::kTriggerMode, 1, true), Status::kSuccess);
}

TEST(Registers, TellReadOnlyFromUnknownAndFromMisaligned) {
  const Registers registers = powerOn();
  EXPECT_EQ(registers.checkWrite(reg::kSensorWidth, 1, false), Status::kWriteProtect);
  EXPECT_EQ(registers.checkWrite(0x7000, 1, false), Status::kInvalidAddress);
  EXPECT_EQ(registers.checkWrite(0x0a01, 1, false), Status::kBadAlignment);
  EXPECT_EQ(registers.checkRead(reg::kAcquisitionStart), Status::kInvalidAddress);  // write only
  EXPECT_EQ(registers.checkRead(0xffff'fffc), Status::kInvalidAddress);
}

TEST(Registers, ServeTheGenicamFileToItsEndAndNoFurther) {
  const Registers registers = powerOn();
  std::array<std::uint8_t, 8> bytes{};
  const auto end = static_cast<std::uint32_t>(Registers::kXmlAddress + (kXml.size() + 3) / 4 * 4);
  EXPECT_EQ(registers.readMemory(Registers::kXmlAddress, bytes), Status::kSuccess);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 5), "<?xml");
  EXPECT_EQ(registers.readMemory(end - 8, bytes), Status::kSuccess);
  EXPECT_EQ(registers.readMemory(end - 4, bytes), Status::kInvalidAddress);
  EXPECT_EQ(registers.readMemory(0xffff'fffc, bytes), Status::kInvalidAddress);
}

constexpr ControlChannel::Peer kFirst{0x7f000001, 1000};
constexpr ControlChannel::Peer kSecond{0x7f000001, 1001};

TEST(ControlChannel, BelongsToTheFirstWhoAsks) {
  ControlChannel control;
  EXPECT_FALSE(control.mayWrite(kFirst));
  EXPECT_EQ(control.request(kFirst, ControlChannel::kControl, rt::fromNs(0)), Status::kSuccess);
  EXPECT_EQ(control.request(kSecond, ControlChannel::kControl, rt::fromNs(1)),
            Status::kAccessDenied);
  EXPECT_TRUE(control.mayWrite(kFirst));
  EXPECT_FALSE(control.mayWrite(kSecond));
  EXPECT_TRUE(control.mayRead(kSecond));
  EXPECT_TRUE(control.mayAskAgain(kSecond));  // the stream's socket of the same machine
}

TEST(ControlChannel, ExclusiveHidesTheRegistersFromOthers) {
  ControlChannel control;
  EXPECT_EQ(control.request(kFirst, ControlChannel::kExclusive, rt::fromNs(0)), Status::kSuccess);
  EXPECT_FALSE(control.mayRead(kSecond));
  EXPECT_TRUE(control.mayRead(kFirst));
}

TEST(ControlChannel, IsFreeAgainWhenTheHeartbeatStops) {
  ControlChannel control;
  ASSERT_EQ(control.request(kFirst, ControlChannel::kControl, rt::fromNs(0)), Status::kSuccess);
  control.hear(kSecond, rt::fromNs(0) + 2s);  // another client's message is no heartbeat
  EXPECT_FALSE(control.expire(rt::fromNs(0) + 3s, 3s));
  EXPECT_TRUE(control.expire(rt::fromNs(0) + 3s + 1ns, 3s));
  EXPECT_EQ(control.privilege(), 0u);
  EXPECT_EQ(control.request(kSecond, ControlChannel::kControl, rt::fromNs(0) + 4s),
            Status::kSuccess);
}

TEST(TriggerWire, ReadsEdges) {
  EXPECT_EQ(parseWireEdge("L1+ 123456789"), (WireEdge{true, rt::fromNs(123456789)}));
  EXPECT_EQ(parseWireEdge("L1- 5\n"), (WireEdge{false, rt::fromNs(5)}));
}

TEST(TriggerWire, RefusesEverythingElse) {
  for (const char* text : {"", "L1", "L1+", "L1+ ", "L1+ x", "L1+ 5 6", "L2+ 5", "L1* 5", "L1+ -5",
                           "L1+ 99999999999999999999999"}) {
    EXPECT_FALSE(parseWireEdge(text)) << text;
  }
}

TEST(Validity, HoldsForARunWithoutTrouble) {
  LatenessHistogram lateness;
  lateness.add(100us);
  EXPECT_EQ(
      invalidReason({.counters = {.triggers = 10, .frames_sent = 10}, .lateness = lateness}, 25ms),
      "");
}

TEST(Validity, FallsWithOvertriggersAndSendFailures) {
  EXPECT_NE(invalidReason({.counters = {.overtriggers = 1}}, 25ms), "");
  EXPECT_NE(invalidReason({.counters = {.send_failures = 1}}, 25ms), "");
}

TEST(Validity, FallsWhenPacketsLeaveLate) {
  LatenessHistogram often;
  for (int i = 0; i < 100; ++i) often.add(i < 97 ? 1ms : 6ms);
  EXPECT_NE(invalidReason({.lateness = often}, 25ms), "");
  LatenessHistogram once;
  for (int i = 0; i < 1000; ++i) once.add(1ms);
  once.add(26ms);
  EXPECT_EQ(invalidReason({.lateness = once}, 30ms), "");
  EXPECT_NE(invalidReason({.lateness = once}, 25ms), "");
}

TEST(Validity, IsJudgedByWhatFollowsTheWarmUp) {
  RunRecord run{.counters = {.overtriggers = 3, .send_failures = 2}};
  run.lateness.add(80ms);
  EXPECT_NE(invalidReason(run, 25ms), "") << "it has not ended";
  run.endWarmUp();
  run.lateness.add(1ms);
  EXPECT_EQ(invalidReason(run, 25ms), "");
  EXPECT_EQ(run.early_lateness.max(), 80ms) << "it is reported all the same";

  RunRecord late = run;
  late.lateness.add(26ms);
  EXPECT_NE(invalidReason(late, 25ms), "");
  RunRecord busy = run;
  ++busy.counters.overtriggers;
  EXPECT_THAT(invalidReason(busy, 25ms), testing::HasSubstr("1 trigger edges"));
  RunRecord refused = run;
  ++refused.counters.send_failures;
  EXPECT_THAT(invalidReason(refused, 25ms), testing::HasSubstr("1 packets"));
}

TEST(LatenessHistogram, GivesQuantilesWithinItsStep) {
  LatenessHistogram lateness;
  for (int i = 1; i <= 100; ++i) lateness.add(i * 100us);
  EXPECT_NEAR(static_cast<double>(lateness.quantile(0.5).count()), 5e6, 2e4);
  EXPECT_NEAR(static_cast<double>(lateness.quantile(0.99).count()), 9.9e6, 2e4);
  EXPECT_EQ(lateness.max(), 10ms);
  EXPECT_EQ(LatenessHistogram().quantile(0.5), 0ns);
}

}  // namespace
