#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "appliance/render/moment_hold.h"
#include "rt/pin_budget.h"

namespace {

using appliance::FramePin;
using appliance::MomentHold;
using appliance::PinnedFrame;
using appliance::StoredFrames;
using appliance::StoredRange;

/// Three cameras; a test puts frames in and takes them out. Pins are counted per camera.
class FakeMemory final : public StoredFrames {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 3; }
  [[nodiscard]] StoredRange range(std::uint32_t /*camera*/) const noexcept override {
    return {.oldest = 1, .newest = 100};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    return stored.contains({camera, trigger});
  }
  [[nodiscard]] bool living(std::uint32_t /*camera*/) const noexcept override { return true; }
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                  std::uint64_t trigger) noexcept override {
    if (!holds(camera, trigger) || !budgets[camera].trySpend()) return std::nullopt;
    return PinnedFrame{.pin = FramePin(rt::SlotPin{}, budgets[camera]),
                       .frame = {.trigger = trigger, .frame_id = camera}};
  }

  void storeAll(std::uint64_t trigger) {
    for (std::uint32_t camera = 0; camera < 3; ++camera) stored.insert({camera, trigger});
  }

  std::set<std::pair<std::uint32_t, std::uint64_t>> stored;
  std::array<rt::PinBudget, 3> budgets{rt::PinBudget(MomentHold::kPinsPerCamera + 1),
                                       rt::PinBudget(MomentHold::kPinsPerCamera + 1),
                                       rt::PinBudget(MomentHold::kPinsPerCamera + 1)};
};

class HeldMoment : public testing::Test {
 protected:
  FakeMemory memory;
  MomentHold hold{memory};
};

TEST_F(HeldMoment, StaysWithAllItsViewsWhenTheMemoryForgetsIt) {
  memory.storeAll(7);
  hold.keep(7);
  memory.stored.clear();
  EXPECT_EQ(hold.heldTrigger(), 7U);
  for (std::uint32_t camera = 0; camera < 3; ++camera) {
    EXPECT_TRUE(hold.holds(camera, 7));
    const auto frame = hold.tryPin(camera, 7);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->frame.trigger, 7U);
    EXPECT_EQ(frame->frame.frame_id, camera);
  }
}

TEST_F(HeldMoment, TakesTheFramesThatWereStillOnTheirWay) {
  memory.stored = {{1, 7}};
  hold.keep(7);
  EXPECT_FALSE(hold.holds(0, 7));
  memory.stored.insert({0, 7});
  hold.keep(7);
  memory.stored.clear();
  EXPECT_TRUE(hold.holds(0, 7));
  EXPECT_TRUE(hold.holds(1, 7));
  EXPECT_FALSE(hold.holds(2, 7)) << "this camera has no frame of the moment";
}

TEST_F(HeldMoment, GivesWayToTheNextOneAndFreesItsPins) {
  memory.storeAll(7);
  memory.storeAll(8);
  hold.keep(7);
  hold.keep(8);
  EXPECT_EQ(hold.heldTrigger(), 8U);
  memory.stored.clear();
  EXPECT_FALSE(hold.holds(0, 7));
  EXPECT_TRUE(hold.holds(0, 8));
  for (const rt::PinBudget& budget : memory.budgets) EXPECT_EQ(budget.used(), 1U);
  hold.keep(0);
  EXPECT_EQ(hold.heldTrigger(), 0U);
  for (const rt::PinBudget& budget : memory.budgets) EXPECT_EQ(budget.used(), 0U);
}

TEST_F(HeldMoment, StaysIfNothingOfTheNextOneIsThere) {
  memory.storeAll(7);
  hold.keep(7);
  memory.stored.clear();
  hold.keep(6);
  EXPECT_EQ(hold.heldTrigger(), 7U);
  EXPECT_TRUE(hold.holds(2, 7));
}

TEST_F(HeldMoment, LeavesOtherMomentsToTheMemory) {
  memory.storeAll(7);
  memory.storeAll(9);
  hold.keep(7);
  EXPECT_TRUE(hold.holds(0, 9));
  const auto frame = hold.tryPin(0, 9);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->frame.trigger, 9U);
  EXPECT_EQ(hold.range(0).newest, 100U);
}

TEST_F(HeldMoment, KeepsWithinItsBudgetHoweverOftenItChanges) {
  for (std::uint64_t trigger = 1; trigger <= 50; ++trigger) {
    memory.storeAll(trigger);
    const auto shown = hold.tryPin(1, trigger);
    hold.keep(trigger);
    EXPECT_EQ(hold.heldTrigger(), trigger);
    memory.stored.clear();
  }
  for (const rt::PinBudget& budget : memory.budgets) EXPECT_EQ(budget.refused(), 0U);
}

}  // namespace
