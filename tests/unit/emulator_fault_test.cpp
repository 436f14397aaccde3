#include <string>

#include <gtest/gtest.h>

#include "hal/emulated/rig/camera_clock.h"
#include "hal/emulated/rig/fault_command.h"
#include "hal/emulated/rig/fault_state.h"
#include "hal/emulated/rig/packet_faults.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;

constexpr std::uint32_t kCameras = 20;
const rt::Timestamp kNow = rt::fromNs(1'000'000'000'000);

TEST(FaultCommand, NamesOneCameraOrAll) {
  EXPECT_EQ(parseFaultCommand("7 kill", kCameras), (FaultCommand{6, Fault::kKill, 0}));
  EXPECT_EQ(parseFaultCommand("all clear\n", kCameras), (FaultCommand{{}, Fault::kClear, 0}));
  EXPECT_EQ(parseFaultCommand("  20   freeze ", kCameras), (FaultCommand{19, Fault::kFreeze, 0}));
}

TEST(FaultCommand, TakesEveryFaultOfTheManual) {
  for (const char* text :
       {"ignore-triggers 3", "ignore-every 2", "extra-frame", "late-leader 25", "kill", "revive",
        "reboot 2.5", "freeze", "thaw", "wrong-size on", "wrong-size off", "drift -100", "loss 0.5",
        "reorder 10", "duplicate 100", "frame-id 65530", "link 100", "mtu 1400", "clear"}) {
    const auto command = parseFaultCommand("1 " + std::string(text), kCameras);
    ASSERT_TRUE(command) << text << ": " << command.error();
    EXPECT_EQ(faultText(*command), text);
  }
}

TEST(FaultCommand, RebootsForASecondUnlessToldHowLong) {
  EXPECT_EQ(parseFaultCommand("1 reboot", kCameras), (FaultCommand{0, Fault::kReboot, 1}));
}

TEST(FaultCommand, AnswersWhatIsNoCommandWithOneClearLine) {
  const struct {
    const char* text;
    const char* says;
  } cases[] = {{"", "<camera | all> <fault>"},
               {"kill", "<camera | all> <fault>"},
               {"0 kill", "1 to 20"},
               {"21 kill", "1 to 20"},
               {"-1 kill", "1 to 20"},
               {"seven kill", "1 to 20"},
               {"99999999999 kill", "1 to 20"},
               {"1 explode", "no fault 'explode'"},
               {"1 kill 5", "kill without an argument"},
               {"1 loss", "loss with a number from 0 to 100"},
               {"1 loss 101", "loss with a number from 0 to 100"},
               {"1 loss nan", "loss with a number from 0 to 100"},
               {"1 loss 5%", "loss with a number from 0 to 100"},
               {"1 ignore-triggers 1.5", "a whole number"},
               {"1 ignore-triggers -1", "a whole number"},
               {"1 frame-id 0", "1 to 65535"},
               {"1 frame-id 65536", "1 to 65535"},
               {"1 wrong-size", "on|off"},
               {"1 wrong-size 1", "on|off"},
               {"1 loss 5 5", "loss with a number"},
               {"1 \x1b[31mkill", "'?[31mkill'"}};
  for (const auto& bad : cases) {
    const auto command = parseFaultCommand(bad.text, kCameras);
    ASSERT_FALSE(command) << bad.text;
    EXPECT_NE(command.error().find(bad.says), std::string::npos)
        << bad.text << " -> " << command.error();
    EXPECT_EQ(command.error().find('\n'), std::string::npos);
  }
  const auto endless = parseFaultCommand("1 " + std::string(400, 'x'), kCameras);
  ASSERT_FALSE(endless);
  EXPECT_LT(endless.error().size(), 450U);
}

FaultState with(std::initializer_list<const char*> commands) {
  FaultState state;
  for (const char* text : commands) {
    state.apply(*parseFaultCommand("1 " + std::string(text), 1), kNow);
  }
  return state;
}

TEST(FaultState, IsHarmlessAtFirst) {
  FaultState state;
  EXPECT_FALSE(state.isDark(kNow));
  EXPECT_FALSE(state.isFrozen());
  EXPECT_FALSE(state.sendsWrongSize());
  EXPECT_FALSE(state.wantsExtraFrame());
  EXPECT_EQ(state.takeHold(), 0ns);
  EXPECT_EQ(state.swallowEdge(), std::nullopt);
}

TEST(FaultState, IgnoresAsManyEdgesAsToldAndFollowsTheNext) {
  FaultState state = with({"ignore-triggers 2"});
  EXPECT_EQ(state.swallowEdge(), Fault::kIgnoreTriggers);
  EXPECT_EQ(state.swallowEdge(), Fault::kIgnoreTriggers);
  EXPECT_EQ(state.swallowEdge(), std::nullopt);
}

TEST(FaultState, IgnoresEverySecondUntilToldOtherwise) {
  FaultState state = with({"ignore-every 2"});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(state.swallowEdge(), std::nullopt);
    EXPECT_EQ(state.swallowEdge(), Fault::kIgnoreEvery);
  }
  state.apply({0, Fault::kIgnoreEvery, 0}, kNow);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(state.swallowEdge(), std::nullopt);
}

TEST(FaultState, FollowsNoEdgeWhileFrozen) {
  FaultState state = with({"freeze"});
  EXPECT_EQ(state.swallowEdge(), Fault::kFreeze);
  state.apply({0, Fault::kThaw, 0}, kNow);
  EXPECT_EQ(state.swallowEdge(), std::nullopt);
}

TEST(FaultState, HoldsBackOneFrame) {
  FaultState state = with({"late-leader 25"});
  EXPECT_EQ(state.takeHold(), 25ms);
  EXPECT_EQ(state.takeHold(), 0ns);
}

TEST(FaultState, OwesAsManyExtraFramesAsWereAskedFor) {
  FaultState state = with({"extra-frame", "extra-frame"});
  state.extraFrameTaken();
  EXPECT_TRUE(state.wantsExtraFrame());
  state.extraFrameTaken();
  EXPECT_FALSE(state.wantsExtraFrame());
}

TEST(FaultState, IsDarkUntilRevivedOrBooted) {
  FaultState state = with({"kill"});
  EXPECT_TRUE(state.isDark(kNow + 1h));
  EXPECT_EQ(state.darkBecause(), Fault::kKill);
  state.apply({0, Fault::kRevive, 0}, kNow);
  EXPECT_FALSE(state.isDark(kNow));
  state.apply({0, Fault::kReboot, 2}, kNow);
  EXPECT_TRUE(state.isDark(kNow + 1999ms));
  EXPECT_EQ(state.darkBecause(), Fault::kReboot);
  EXPECT_FALSE(state.isDark(kNow + 2s));
}

TEST(FaultState, ARebootCuresTheCameraButNotItsCable) {
  const FaultState state =
      with({"freeze", "wrong-size on", "ignore-every 2", "kill", "link 100", "reboot 1"});
  EXPECT_FALSE(state.isFrozen());
  EXPECT_FALSE(state.sendsWrongSize());
  EXPECT_TRUE(state.isDark(kNow + 1h));
  EXPECT_EQ(state.linkMbps(), 100);
}

TEST(FaultState, ClearEndsEverythingButARebootUnderWay) {
  const FaultState state =
      with({"kill", "freeze", "wrong-size on", "link 10", "reboot 1", "kill", "clear"});
  EXPECT_FALSE(state.isFrozen());
  EXPECT_FALSE(state.sendsWrongSize());
  EXPECT_EQ(state.linkMbps(), 0);
  EXPECT_TRUE(state.isDark(kNow + 999ms));
  EXPECT_FALSE(state.isDark(kNow + 1s));
}

TEST(PacketFaults, DoNothingUnlessTold) {
  LossModel rig(0, 1);
  PacketFaults faults(rig, 1);
  EXPECT_FALSE(faults.rearranges());
  EXPECT_TRUE(faults.carries(9000));
  for (int i = 0; i < 1000; ++i) {
    ASSERT_FALSE(faults.loses() || faults.overtaken() || faults.doubled());
  }
}

TEST(PacketFaults, LoseAsManyAsToldAndWhatTheRigsWireLoses) {
  LossModel lossless(0, 1);
  PacketFaults own(lossless, 1);
  own.setLoss(0.1);
  int lost = 0;
  for (int i = 0; i < 10'000; ++i) lost += own.loses() ? 1 : 0;
  EXPECT_NEAR(lost, 1000, 200);
  own.clear();
  EXPECT_FALSE(own.loses());
  LossModel all(1, 1);
  EXPECT_TRUE(PacketFaults(all, 1).loses());
}

TEST(PacketFaults, CarryNoDatagramLargerThanThePath) {
  LossModel rig(0, 1);
  PacketFaults faults(rig, 1);
  faults.setMtu(1500);
  EXPECT_TRUE(faults.carries(1500));
  EXPECT_FALSE(faults.carries(1501));
}

TEST(CameraClock, DriftsWithoutAStepAndRestartsNearZero) {
  CameraClock clock(0);
  const auto before = clock.ticks(kNow);
  EXPECT_EQ(before, static_cast<std::uint64_t>(rt::toNs(kNow)));
  clock.drift(kNow, 100);
  EXPECT_EQ(clock.ticks(kNow), before);
  EXPECT_EQ(clock.ticks(kNow + 1s), before + 1'000'100'000U);
  clock.drift(kNow + 1s, 0);
  EXPECT_EQ(clock.ticks(kNow + 2s), before + 2'000'100'000U);
  clock.restart(kNow + 2s);
  EXPECT_EQ(clock.ticks(kNow + 3s), 1'000'000'000U);
  EXPECT_EQ(clock.ticks(kNow), 1U) << "a clock that says 0 is none";
}

}  // namespace
