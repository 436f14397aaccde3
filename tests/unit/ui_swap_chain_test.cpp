#include <gtest/gtest.h>

#include "ui-kms/swap_chain.h"

namespace {

using ui::BufferState;
using ui::SwapChain;

constexpr std::int64_t kPeriodNs = 10'000'000;

rt::Timestamp atPeriods(double periods) {
  return rt::fromNs(static_cast<std::int64_t>(periods * kPeriodNs));
}

SwapChain chainOf(std::uint32_t buffers) {
  return {buffers, ui::FlipGrid(rt::fromNs(0), 1e9 / kPeriodNs)};
}

/// Draws and commits at @p periods; the buffer used.
std::uint32_t show(SwapChain& chain, std::uint64_t picture_id, double periods) {
  const auto buffer = chain.tryBeginDraw(atPeriods(periods));
  EXPECT_TRUE(buffer);
  chain.finishDraw(*buffer);
  EXPECT_TRUE(chain.commit(picture_id, atPeriods(periods)));
  return *buffer;
}

TEST(SwapChain, APictureFlipsAtTheFirstVblankAfterItsCommit) {
  SwapChain chain = chainOf(3);
  show(chain, 7, 2.5);
  EXPECT_FALSE(chain.tryPopFlip(atPeriods(2.99)));
  const auto flip = chain.tryPopFlip(atPeriods(3));
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->picture_id, 7U);
  EXPECT_EQ(flip->vblank, 3U);
  EXPECT_EQ(flip->page_flip, atPeriods(3));
  EXPECT_FALSE(chain.tryPopFlip(atPeriods(9)));
}

TEST(SwapChain, ASecondCommitBeforeTheFlipIsBusyAndLeavesThePictureDrawn) {
  SwapChain chain = chainOf(3);
  show(chain, 1, 0.1);
  const auto second = chain.tryBeginDraw(atPeriods(0.2));
  ASSERT_TRUE(second);
  chain.finishDraw(*second);
  const auto refused = chain.commit(2, atPeriods(0.3));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, rt::Errc::kBusy);
  EXPECT_EQ(chain.state(*second), BufferState::kDrawn);
  EXPECT_TRUE(chain.commit(2, atPeriods(1.3)));
}

TEST(SwapChain, TwoBuffersAreBusyUntilTheFlipFreesOne) {
  SwapChain chain = chainOf(2);
  show(chain, 1, 0.1);
  show(chain, 2, 1.1);  // 1 on screen, 2 pending
  const auto none = chain.tryBeginDraw(atPeriods(1.5));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, rt::Errc::kBusy);
  EXPECT_TRUE(chain.tryBeginDraw(atPeriods(2.0)));
}

TEST(SwapChain, ThreeBuffersLeaveOneToDrawIntoWhileAnotherIsPending) {
  SwapChain chain = chainOf(3);
  const auto first = show(chain, 1, 0.1);
  const auto second = show(chain, 2, 1.1);
  const auto third = chain.tryBeginDraw(atPeriods(1.5));
  ASSERT_TRUE(third);
  EXPECT_EQ(chain.state(first), BufferState::kOnScreen);
  EXPECT_EQ(chain.state(second), BufferState::kPending);
  EXPECT_NE(*third, first);
  EXPECT_NE(*third, second);
}

TEST(SwapChain, DrawingAgainBeforeTheCommitReplacesThePicture) {
  SwapChain chain = chainOf(3);
  const auto first = chain.tryBeginDraw(atPeriods(0));
  ASSERT_TRUE(first);
  chain.finishDraw(*first);
  EXPECT_EQ(*chain.tryBeginDraw(atPeriods(0.1)), *first);
}

TEST(SwapChain, ACommitOfNothingIsRefused) {
  SwapChain chain = chainOf(3);
  EXPECT_FALSE(chain.commit(1, atPeriods(0)));
  show(chain, 2, 0.5);
  EXPECT_FALSE(chain.commit(3, atPeriods(5)));
}

TEST(SwapChain, FlipsThatNobodyTakesAreOverwrittenOldestFirst) {
  SwapChain chain = chainOf(3);
  for (std::uint64_t id = 1; id <= ui::FlipList::kKept + 3; ++id) {
    show(chain, id, static_cast<double>(id) + 0.5);
  }
  const auto late = atPeriods(1'000);
  std::uint64_t expected = 4;
  while (const auto flip = chain.tryPopFlip(late)) EXPECT_EQ(flip->picture_id, expected++);
  EXPECT_EQ(expected, ui::FlipList::kKept + 4);
}

}  // namespace
