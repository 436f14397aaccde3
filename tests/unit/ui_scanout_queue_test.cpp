#include <gtest/gtest.h>

#include "ui-kms/scanout_queue.h"

namespace {

using ui::BufferState;
using ui::ScanoutQueue;

rt::Timestamp at(int ms) {
  return rt::fromNs(ms * 1'000'000LL);
}

/// Draws a picture and hands it over, as a display does.
void show(ScanoutQueue& queue, std::uint64_t id) {
  const auto buffer = queue.tryBeginDraw();
  ASSERT_TRUE(buffer);
  queue.finishDraw(*buffer);
  ASSERT_TRUE(queue.takesCommit());
  if (queue.pending()) {
    queue.queue(*buffer, id);
  } else {
    queue.submitted(*buffer, id, id);
  }
}

TEST(ScanoutQueue, ABufferIsDrawnPendingOnScreenAndFree) {
  ScanoutQueue queue(1);
  EXPECT_EQ(queue.buffers(), 3U);
  const std::uint32_t buffer = queue.tryBeginDraw().value();
  EXPECT_EQ(queue.state(buffer), BufferState::kFree) << "until it is drawn";
  queue.finishDraw(buffer);
  EXPECT_EQ(queue.drawn(), buffer);
  EXPECT_EQ(queue.tryBeginDraw().value(), buffer) << "a drawn one that is not shown is drawn over";
  queue.submitted(buffer, 7, 70);
  EXPECT_EQ(queue.state(buffer), BufferState::kPending);
  EXPECT_FALSE(queue.takesCommit());
  EXPECT_FALSE(queue.committedFlip());
  EXPECT_EQ(queue.pendingBuffer(70), buffer);
  queue.onFlip(70, 3, at(50));
  EXPECT_EQ(queue.state(buffer), BufferState::kOnScreen);
  EXPECT_EQ(queue.committedFlip()->page_flip, at(50));
  show(queue, 8);
  EXPECT_EQ(queue.state(buffer), BufferState::kOnScreen) << "until the next one is";
  queue.onFlip(8, 4, at(66));
  EXPECT_EQ(queue.state(buffer), BufferState::kFree);
}

TEST(ScanoutQueue, TellsEveryFlipOnceInOrder) {
  ScanoutQueue queue(1);
  for (std::uint64_t id = 1; id <= 3; ++id) {
    show(queue, id);
    queue.onFlip(id, 10 + id, at(static_cast<int>(id)));
  }
  for (std::uint64_t id = 1; id <= 3; ++id) {
    const auto flip = queue.tryPopFlip();
    ASSERT_TRUE(flip);
    EXPECT_EQ(flip->picture_id, id);
    EXPECT_EQ(flip->vblank, 10 + id);
  }
  EXPECT_FALSE(queue.tryPopFlip());
}

TEST(ScanoutQueue, OfDepthTwoHoldsOneBackUntilTheFlip) {
  ScanoutQueue queue(2);
  EXPECT_EQ(queue.buffers(), 4U);
  show(queue, 1);
  EXPECT_TRUE(queue.takesCommit());
  show(queue, 2);
  EXPECT_TRUE(queue.queued());
  EXPECT_FALSE(queue.takesCommit());
  EXPECT_FALSE(queue.due()) << "the first is pending";
  queue.onFlip(1, 1, at(16));
  ASSERT_TRUE(queue.due());
  EXPECT_EQ(queue.due()->picture_id, 2U);
  queue.submitted(queue.due()->buffer, 2, 2);
  EXPECT_FALSE(queue.queued());
  show(queue, 3);
  queue.onFlip(2, 2, at(33));
  EXPECT_EQ(queue.due()->picture_id, 3U);
}

TEST(ScanoutQueue, OfDepthTwoHasABufferToDrawWhileTwoAreOnTheirWay) {
  ScanoutQueue queue(2);
  show(queue, 1);
  queue.onFlip(1, 1, at(16));
  show(queue, 2);
  show(queue, 3);
  EXPECT_TRUE(queue.tryBeginDraw());
}

TEST(ScanoutQueue, TheCommittedPictureIsTheNewestEvenWhileItIsQueued) {
  ScanoutQueue queue(2);
  show(queue, 1);
  show(queue, 2);
  const auto newest = queue.committed();
  queue.onFlip(1, 1, at(16));
  EXPECT_EQ(queue.committed(), newest);
  EXPECT_FALSE(queue.committedFlip()) << "that was the first one's";
  queue.submitted(queue.due()->buffer, 2, 2);
  queue.onFlip(2, 2, at(33));
  EXPECT_EQ(queue.committedFlip()->picture_id, 2U);
}

TEST(ScanoutQueue, AFlipFromBeforeALossIsIgnored) {
  ScanoutQueue queue(1);
  show(queue, 1);
  queue.dropAll();
  EXPECT_FALSE(queue.committed());
  show(queue, 2);
  EXPECT_FALSE(queue.pendingBuffer(1));
  queue.onFlip(1, 1, at(16));
  EXPECT_TRUE(queue.pending());
  EXPECT_FALSE(queue.tryPopFlip());
  queue.onFlip(2, 2, at(33));
  EXPECT_EQ(queue.tryPopFlip()->picture_id, 2U);
}

TEST(ScanoutQueue, KeepsTheNewestFlipsThatNobodyTakes) {
  ScanoutQueue queue(1);
  constexpr std::uint64_t kMore = ui::FlipList::kKept + 5;
  for (std::uint64_t id = 1; id <= kMore; ++id) {
    show(queue, id);
    queue.onFlip(id, id, at(static_cast<int>(id)));
  }
  EXPECT_EQ(queue.tryPopFlip()->picture_id, 6U);
}

}  // namespace
