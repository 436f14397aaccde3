#include <functional>
#include <optional>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/soak/faults.h"
#include "tests/soak/judgement.h"
#include "tests/soak/loss_account.h"
#include "tests/soak/memory_growth.h"

namespace {

using namespace soak;  // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr rt::Nanoseconds kPeriod = 25ms;
constexpr rt::Timestamp kStart = rt::fromNs(1'000'000'000);

rt::Timestamp edgeOf(std::uint64_t trigger) {
  return kStart + kPeriod * static_cast<std::int64_t>(trigger);
}

/// Two cameras over 400 triggers (10 s); what is not asked otherwise comes and is stored.
struct Simulation {
  std::uint64_t triggers = 400;
  std::function<bool(std::uint32_t, std::uint64_t)> sends = [](auto, auto) { return true; };
  std::function<rt::Nanoseconds(std::uint64_t)> sending = [](auto) { return 11ms; };
  std::function<std::optional<appliance::FrameRecord>(appliance::FrameRecord)> arrives =
      [](const appliance::FrameRecord& frame) { return frame; };

  [[nodiscard]] LossAccount run() const {
    LossAccount account(2, kPeriod);
    for (std::uint64_t t = 1; t <= triggers; ++t) {
      const rt::Timestamp edge = edgeOf(t);
      account.triggerFired({.trigger = t,
                            .deadline = edge,
                            .trigger_edge_before = edge,
                            .trigger_edge_after = edge + 10us});
      for (std::uint32_t camera = 0; camera < 2; ++camera) {
        if (!sends(camera, t)) continue;
        account.frameSent({.camera = camera,
                           .frame_id = (t - 1) % 65535 + 1,
                           .trigger = t,
                           .trigger_edge = edge + 5us,
                           .exposure_end = edge + 1ms,
                           .first_packet = edge + 1ms,
                           .last_packet = edge + 1ms + sending(t)});
        const auto frame = arrives({.camera = camera,
                                    .status = hal::FrameStatus::kComplete,
                                    .trigger = t,
                                    .frame_id = t,
                                    .first_packet = edge + 1ms,
                                    .last_packet = edge + 12ms,
                                    .frame_ready = edge + 12ms});
        if (frame) account.frameArrived(*frame);
      }
    }
    account.finish(edgeOf(triggers));
    return account;
  }
};

TEST(LossAccount, FindsNothingWhereEveryFrameIsStored) {
  const LossAccount account = Simulation{}.run();
  EXPECT_THAT(account.lost(), IsEmpty());
  EXPECT_THAT(account.misattributed(), IsEmpty());
  EXPECT_EQ(account.triggersJudged(), 320u);  // less the settling's 2 s
  EXPECT_EQ(account.framesStored(), 640u);
}

TEST(LossAccount, TellsAFrameThatWasNotSentFromOneThatNeverCame) {
  Simulation simulation;
  simulation.sends = [](std::uint32_t camera, std::uint64_t t) { return camera != 1 || t != 200; };
  simulation.arrives = [](const appliance::FrameRecord& frame) {
    return frame.camera == 0 && frame.trigger == 300 ? std::nullopt : std::optional(frame);
  };
  const LossAccount account = simulation.run();
  ASSERT_THAT(account.lost(), SizeIs(2));
  EXPECT_EQ(account.lost()[0].cause, LossCause::kNotSent);
  EXPECT_EQ(account.lost()[0].camera, 1u);
  EXPECT_EQ(account.lost()[0].trigger, 200u);
  EXPECT_EQ(account.lost()[0].edge, edgeOf(200));
  EXPECT_EQ(account.lost()[1].cause, LossCause::kNeverCame);
  EXPECT_EQ(account.lost()[1].camera, 0u);
}

TEST(LossAccount, NamesWhatTheBoxSaidOfAFrameThatCame) {
  Simulation simulation;
  simulation.arrives = [](appliance::FrameRecord frame) {
    if (frame.camera == 0) return std::optional(frame);
    if (frame.trigger == 200) frame.status = hal::FrameStatus::kIncomplete;
    if (frame.trigger == 201) frame.status = hal::FrameStatus::kWrongSize;
    if (frame.trigger >= 200 && frame.trigger <= 202) frame.trigger = 0;
    return std::optional(frame);
  };
  const LossAccount account = simulation.run();
  ASSERT_THAT(account.lost(), SizeIs(3));
  EXPECT_EQ(account.lost()[0].cause, LossCause::kIncomplete);
  EXPECT_EQ(account.lost()[1].cause, LossCause::kWrongSize);
  EXPECT_EQ(account.lost()[2].cause, LossCause::kUnattributed);
}

TEST(LossAccount, NamesAFrameThatTheEmulatorItselfHeldUp) {
  Simulation simulation;
  simulation.sending = [](std::uint64_t t) { return t == 200 ? 20ms : 11ms; };
  simulation.arrives = [](appliance::FrameRecord frame) {
    const bool lost = frame.trigger == 200 || frame.trigger == 201;
    if (lost) frame.status = hal::FrameStatus::kIncomplete;
    if (lost) frame.trigger = 0;
    return std::optional(frame);
  };
  const LossAccount account = simulation.run();
  ASSERT_THAT(account.lost(), SizeIs(4));
  EXPECT_EQ(account.lost()[0].cause, LossCause::kHeldUp);
  EXPECT_EQ(account.lost()[2].cause, LossCause::kIncomplete);
  const Judgement judgement = judge(account.lost(), {}, {}, kPeriod);
  EXPECT_THAT(judgement.stood_still, SizeIs(2));
  EXPECT_THAT(judgement.unexplained, SizeIs(2));
}

TEST(LossAccount, TakesAFrameOfItsOwnForAnEdgeThatItMet) {
  LossAccount account(1, kPeriod);
  for (std::uint64_t t = 1; t <= 400; ++t) {
    const rt::Timestamp edge = edgeOf(t);
    account.triggerFired({.trigger = t,
                          .deadline = edge,
                          .trigger_edge_before = edge,
                          .trigger_edge_after = edge + 10us});
    // The camera was busy with a frame of its own when edge 300 came, and taken for edge 310 is one
    // of 8 ms before.
    const rt::Nanoseconds early = t == 300 ? 600us : t == 310 ? 8ms : -5us;
    account.frameSent({.camera = 0,
                       .frame_id = t,
                       .trigger = early > 0ns ? 0 : t,
                       .trigger_edge = edge - early,
                       .first_packet = edge + 1ms});
    account.frameArrived({.camera = 0, .trigger = t, .frame_id = t, .first_packet = edge + 1ms});
  }
  account.finish(edgeOf(400));
  ASSERT_THAT(account.misattributed(), SizeIs(1));
  EXPECT_EQ(account.misattributed()[0].trigger, 310u);
}

TEST(LossAccount, CatchesAFrameThatIsStoredForAnotherTrigger) {
  Simulation simulation;
  simulation.sends = [](std::uint32_t camera, std::uint64_t t) { return camera != 0 || t != 250; };
  simulation.arrives = [](appliance::FrameRecord frame) {
    if (frame.camera == 0 && frame.trigger == 251) frame.trigger = 250;
    return std::optional(frame);
  };
  const LossAccount account = simulation.run();
  ASSERT_THAT(account.misattributed(), SizeIs(1));
  EXPECT_EQ(account.misattributed()[0].trigger, 250u);
  ASSERT_THAT(account.lost(), SizeIs(1));
  EXPECT_EQ(account.lost()[0].trigger, 251u);
}

TEST(LossAccount, DoesNotJudgeTheFirstSecondsNorWhatWasOnTheWireAtTheEnd) {
  Simulation simulation;
  simulation.arrives = [](const appliance::FrameRecord& frame) {
    return frame.trigger <= 40 ? std::nullopt : std::optional(frame);
  };
  LossAccount account = simulation.run();
  EXPECT_THAT(account.lost(), IsEmpty());
  EXPECT_EQ(account.lostWhileSettling(), 80u);
  account.triggerFired({.trigger = 401,
                        .deadline = edgeOf(401),
                        .trigger_edge_before = edgeOf(401),
                        .trigger_edge_after = edgeOf(401)});
  account.finish(edgeOf(400));
  EXPECT_THAT(account.lost(), IsEmpty());
}

const FaultKind kPulled{.name = "pulled",
                        .begin = "kill",
                        .end = "revive",
                        .may_lose = {LossCause::kNotSent, LossCause::kNeverCame},
                        .recovery = 2s};
const FaultKind kIgnores{.name = "ignores",
                         .begin = "ignore-triggers 2",
                         .lasts = 1s,
                         .may_lose = {LossCause::kNotSent},
                         .most_frames = 2};

LostFrame lostAt(rt::Nanoseconds after, LossCause cause = LossCause::kNotSent,
                 std::uint32_t camera = 6) {
  return {.camera = camera, .cause = cause, .trigger = 1, .edge = kStart + after};
}

Judgement judgePulled(std::vector<LostFrame> lost) {
  const std::vector<Fault> faults = {
      {.kind = &kPulled, .camera = 6, .from = kStart + 10s, .until = kStart + 12s}};
  return judge(lost, faults, {}, kPeriod);
}

TEST(Judgement, ExplainsALossByAFaultOnItsCameraAtItsTime) {
  const Judgement judgement =
      judgePulled({lostAt(10s), lostAt(11s, LossCause::kNeverCame), lostAt(13s)});
  EXPECT_THAT(judgement.unexplained, IsEmpty());
  EXPECT_EQ(judgement.faults[0].lostFrames(), 3u);
  EXPECT_EQ(judgement.faults[0].back_after, 1s + kPeriod);
}

TEST(Judgement, LeavesOtherCamerasOtherTimesAndOtherCausesUnexplained) {
  EXPECT_THAT(judgePulled({lostAt(11s, LossCause::kNotSent, 5)}).unexplained, SizeIs(1));
  EXPECT_THAT(judgePulled({lostAt(9s)}).unexplained, SizeIs(1));
  EXPECT_THAT(judgePulled({lostAt(14s + 1ms)}).unexplained, SizeIs(1));
  EXPECT_THAT(judgePulled({lostAt(11s, LossCause::kWrongSize)}).unexplained, SizeIs(1));
}

TEST(Judgement, GrantsAFaultNoMoreFramesThanItMayLose) {
  const std::vector<Fault> faults = {
      {.kind = &kIgnores, .camera = 6, .from = kStart, .until = kStart + 1s}};
  const std::vector<LostFrame> lost = {lostAt(10ms), lostAt(35ms), lostAt(60ms)};
  const Judgement judgement = judge(lost, faults, {}, kPeriod);
  ASSERT_THAT(judgement.unexplained, SizeIs(1));
  EXPECT_EQ(judgement.unexplained[0].edge, kStart + 60ms);
}

TEST(Judgement, CountsALossWhileTheMachineStoodStillApart) {
  const std::vector<appliance::StallRecord> stalls = {
      {.cpu = 1, .begin = kStart + 1s, .end = kStart + 1040ms}};
  const std::vector<LostFrame> lost = {
      lostAt(900ms, LossCause::kNeverCame), lostAt(1s, LossCause::kNeverCame),
      lostAt(1060ms, LossCause::kIncomplete), lostAt(1100ms, LossCause::kIncomplete)};
  const Judgement judgement = judge(lost, {}, stalls, kPeriod);
  EXPECT_THAT(judgement.stood_still, SizeIs(2));
  ASSERT_THAT(judgement.unexplained, SizeIs(2));
  EXPECT_EQ(judgement.unexplained[0].edge, kStart + 900ms);
  EXPECT_EQ(judgement.unexplained[1].edge, kStart + 1100ms);
}

TEST(Judgement, TellsAPersonWhichFrame) {
  EXPECT_EQ(describe(lostAt(1500ms), kStart), "camera 7, trigger 1 at 1.500 s: not sent");
  EXPECT_THAT(faultTable(judgePulled({lostAt(11s)}), kStart), HasSubstr("pulled"));
}

TEST(FaultPlan, BringsEveryKindOnceARoundAndTheSameForTheSameSeed) {
  FaultPlan plan(faultKinds(), 20, 10s, 5);
  FaultPlan again(faultKinds(), 20, 10s, 5);
  std::set<const FaultKind*> kinds;
  for (std::size_t i = 0; i < faultKinds().size(); ++i) {
    const PlannedFault fault = plan.next();
    const PlannedFault same = again.next();
    EXPECT_EQ(fault.kind, same.kind);
    EXPECT_EQ(fault.camera, same.camera);
    EXPECT_EQ(fault.lasts, same.lasts);
    EXPECT_LT(fault.camera, 20u);
    EXPECT_GT(fault.lasts, 0s);
    EXPECT_LE(fault.lasts, 5s);
    kinds.insert(fault.kind);
  }
  EXPECT_EQ(kinds.size(), faultKinds().size());
}

std::vector<Holding> holdings(std::int64_t seconds, std::uint64_t bytes_per_second) {
  std::vector<Holding> held;
  for (std::int64_t s = 0; s < seconds; ++s) {
    held.push_back({.at = kStart + std::chrono::seconds(s),
                    .resident_bytes = 1'000'000 + bytes_per_second * static_cast<std::uint64_t>(s),
                    .open_files = 50});
  }
  return held;
}

TEST(Growth, IsWhatIsHeldMoreAtTheEndThanAfterTheWarmUp) {
  const auto growth = growthOf(holdings(100, 1000), kStart + 20s);
  ASSERT_TRUE(growth);
  EXPECT_NEAR(static_cast<double>(growth->resident_bytes), 70'000, 2'000);
  EXPECT_EQ(growth->open_files, 0);
}

TEST(Growth, IsNotJudgedInARunThatIsTooShort) {
  EXPECT_FALSE(growthOf(holdings(35, 0), kStart + 20s));
  EXPECT_FALSE(growthOf({}, kStart));
}

TEST(Growth, SeesWhatThisProcessHolds) {
  const auto held = look(getpid());
  ASSERT_TRUE(held);
  EXPECT_GT(held->resident_bytes, 100'000u);
  EXPECT_GE(held->open_files, 3u);
  EXPECT_FALSE(look(-1));
}

}  // namespace
