#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "rt/pin_budget.h"
#include "rt/slot_pool.h"

namespace {

/// A slot that must be there; an index out of range if not.
std::uint32_t mustAcquire(rt::SlotPool& pool) {
  const auto slot = pool.tryAcquire();
  EXPECT_TRUE(slot.has_value());
  return slot.value_or(pool.size());
}

TEST(SlotState, IsFreeUntilPublishedAndAgainWhenRetired) {
  rt::SlotState state;
  EXPECT_TRUE(state.isFree());
  state.publish(1);
  EXPECT_FALSE(state.isFree());
  EXPECT_TRUE(state.retire());
  EXPECT_TRUE(state.isFree());
}

TEST(SlotState, IsPinnedOnlyUnderItsOwnTagWhilePublished) {
  rt::SlotState state;
  EXPECT_FALSE(state.tryPin(0));  // a fresh word is not "published under tag 0"
  state.publish(rt::SlotState::kMaxTag);
  EXPECT_FALSE(state.tryPin(0));
  EXPECT_FALSE(state.tryPin(rt::SlotState::kMaxTag - 1));
  ASSERT_TRUE(state.tryPin(rt::SlotState::kMaxTag));
  EXPECT_FALSE(state.retire());
  EXPECT_FALSE(state.tryPin(rt::SlotState::kMaxTag));
  state.unpin();
  EXPECT_TRUE(state.isFree());
}

TEST(SlotState, IsFreeOnlyAfterTheLastOfSeveralPins) {
  rt::SlotState state;
  state.publish(9);
  ASSERT_TRUE(state.tryPin(9));
  ASSERT_TRUE(state.tryPin(9));
  EXPECT_FALSE(state.retire());
  state.unpin();
  EXPECT_FALSE(state.isFree());
  state.unpin();
  EXPECT_TRUE(state.isFree());
}

TEST(SlotState, RefusesMorePinsThanItCanCountInsteadOfOverflowing) {
  rt::SlotState state;
  state.publish(5);
  for (std::uint64_t i = 0; i < rt::SlotState::kMaxPins; ++i) ASSERT_TRUE(state.tryPin(5));
  EXPECT_FALSE(state.tryPin(5));
  EXPECT_FALSE(state.retire());
  for (std::uint64_t i = 0; i < rt::SlotState::kMaxPins; ++i) state.unpin();
  EXPECT_TRUE(state.isFree());
}

TEST(SlotPool, HandsOutEverySlotOnceAndThenRefuses) {
  rt::SlotPool pool(4);
  std::set<std::uint32_t> slots;
  for (int i = 0; i < 4; ++i) slots.insert(mustAcquire(pool));
  EXPECT_EQ(slots, (std::set<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_FALSE(pool.tryAcquire().has_value());
}

TEST(SlotPool, ParksAPinnedSlotAndCollectsItOnceUnpinned) {
  rt::SlotPool pool(1);
  const auto slot = mustAcquire(pool);
  pool.publish(slot, 1);
  {
    const auto pin = pool.tryPin(slot, 1);
    ASSERT_TRUE(pin && pin->slot() == slot);
    pool.retire(slot);
    EXPECT_EQ(pool.parkedSlots(), 1u);
    EXPECT_FALSE(pool.tryAcquire().has_value());  // refused immediately, not waited for
    EXPECT_FALSE(pool.tryPin(slot, 1).has_value());
  }
  EXPECT_EQ(pool.tryAcquire(), slot);
  EXPECT_EQ(pool.parkedSlots(), 0u);
}

TEST(SlotPin, UnpinsOnceHoweverOftenItMoves) {
  rt::SlotPool pool(2);
  const auto first = mustAcquire(pool);
  const auto second = mustAcquire(pool);
  pool.publish(first, 1);
  pool.publish(second, 2);
  {
    auto shown = pool.tryPin(first, 1);
    auto held = std::move(shown);
    auto next = pool.tryPin(second, 2);
    held = std::move(next);  // drops the first immediately
    ASSERT_TRUE(held && held->slot() == second);
    pool.retire(first);
    EXPECT_EQ(pool.parkedSlots(), 0u);
  }
  pool.retire(second);
  EXPECT_EQ(pool.freeSlots(), 2u);
}

TEST(SlotPin, HoldsAgainWhatIsParkedAlready) {
  rt::SlotPool pool(2);
  const std::uint32_t slot = mustAcquire(pool);
  pool.publish(slot, 7);
  auto first = pool.tryPin(slot, 7);
  ASSERT_TRUE(first);
  pool.retire(slot);
  auto second = std::optional(first->again());
  first.reset();
  EXPECT_TRUE(pool.tryAcquire());
  EXPECT_FALSE(pool.tryAcquire()) << "the second pin holds the slot";
  second.reset();
  EXPECT_EQ(pool.tryAcquire(), slot);
}

TEST(PinBudget, RefusesAndCountsWhatGoesBeyondIt) {
  rt::PinBudget budget(2);
  EXPECT_TRUE(budget.trySpend());
  EXPECT_TRUE(budget.trySpend());
  EXPECT_FALSE(budget.trySpend());
  EXPECT_EQ(budget.refused(), 1U);
  budget.giveBack();
  EXPECT_EQ(budget.used(), 1U);
  EXPECT_TRUE(budget.trySpend());
}

}  // namespace
