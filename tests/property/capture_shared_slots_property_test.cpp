#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/mman.h>

#include "appliance/capture/frame_history.h"
#include "appliance/capture/shared_slots.h"

namespace {

using namespace appliance;

constexpr std::size_t kPageBytes = 4096;

RC_GTEST_PROP(SlotBlocks, HoldEverySlotOnceWholeAndInOrder, ()) {
  const auto pages = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 40)));
  const auto most_pages = *rc::gen::inRange<std::size_t>(40, 200);
  const auto blocks = planBlocks(pages, most_pages);
  std::size_t slot = 0;
  std::size_t offset = 0;
  for (const SlotBlock& block : blocks) {
    RC_ASSERT(block.first_slot == slot);
    RC_ASSERT(block.offset_bytes == offset);
    RC_ASSERT(block.slots > 0U && slot + block.slots <= pages.size());
    const auto first = pages.begin() + static_cast<std::ptrdiff_t>(slot);
    RC_ASSERT(block.bytes == std::accumulate(first,
                                             first + static_cast<std::ptrdiff_t>(block.slots),
                                             std::size_t{0}));
    RC_ASSERT(block.bytes <= most_pages);
    slot += block.slots;
    offset += block.bytes;
  }
  RC_ASSERT(slot == pages.size());
}

RC_GTEST_PROP(SlotBlocks, AreAsFewAsTheOrderAllows, ()) {
  const auto pages = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 40)));
  const auto most_pages = *rc::gen::inRange<std::size_t>(40, 200);
  const auto blocks = planBlocks(pages, most_pages);
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    RC_ASSERT(blocks[i].bytes + pages[blocks[i + 1].first_slot] > most_pages);
  }
}

TEST(SlotBlocks, AreNoneWhereOneSlotIsTooLarge) {
  const std::vector<std::size_t> slots = {3, 9, 3};
  EXPECT_TRUE(planBlocks(slots, 8).empty());
  EXPECT_EQ(planBlocks(slots, 9).size(), 3U);
  EXPECT_EQ(planBlocks(slots, 15).size(), 1U);
}

TEST(SlotBlocks, OfTwentyCamerasAreFarFewerThanTheirSlots) {
  const std::vector<std::size_t> slots(std::size_t{20} * 312, std::size_t{1280} * 1024);
  EXPECT_LE(planBlocks(slots, std::size_t{64} << 20U).size(), 128U);
}

/// Two cameras of different size that were asked to be shared.
class SharedHistory : public testing::Test {
 protected:
  void SetUp() override {
    auto history = FrameHistory::create({.frame_bytes = {3 * kPageBytes - 100, kPageBytes},
                                         .sets = 12,
                                         .in_flight = 3,
                                         .reserve = 4},
                                        HistorySharing::kShared);
    ASSERT_TRUE(history) << history.error();
    history_ = std::move(*history);
    reader_ = *history_->openReader("test", 4);
  }

  /// Stores triggers 1..last; each frame holds the number of its camera and trigger.
  static void fill(CameraFrames& frames, unsigned camera, std::uint64_t last) {
    std::vector<std::uint32_t> queue(frames.fillingSlots().begin(), frames.fillingSlots().end());
    for (std::uint64_t trigger = 1; trigger <= last; ++trigger) {
      const std::uint32_t slot = queue.front();
      queue.erase(queue.begin());
      for (std::byte& byte : frames.slots()[slot]) byte = mark(camera, trigger);
      queue.push_back(frames.store(slot, {.trigger = trigger}));
    }
  }
  static std::byte mark(unsigned camera, std::uint64_t trigger) {
    return static_cast<std::byte>(100 * camera + trigger);
  }

  std::unique_ptr<FrameHistory> history_;
  FrameReader* reader_ = nullptr;
};

TEST_F(SharedHistory, ServesAsAnyOtherWhetherItCouldBeSharedOrNot) {
  fill(history_->camera(0), 0, 40);
  for (std::uint64_t trigger = 29; trigger <= 40; ++trigger) {
    const auto frame = reader_->tryPin(0, trigger);
    ASSERT_TRUE(frame) << trigger;
    EXPECT_EQ(*frame->pixels, mark(0, trigger));
    EXPECT_EQ(frame->dma_buf.valid(), history_->notShared().empty());
  }
}

TEST_F(SharedHistory, SaysInOneLineWhyItIsNotShared) {
  if (history_->notShared().empty()) GTEST_SKIP() << "this machine makes dma-bufs";
  EXPECT_TRUE(history_->notShared().starts_with("the frame history cannot be shared "));
  EXPECT_EQ(history_->notShared().find('\n'), std::string::npos);
}

TEST_F(SharedHistory, EachFramesDmaBufHoldsThatFrame) {
  if (!history_->notShared().empty()) GTEST_SKIP() << history_->notShared();
  for (unsigned camera = 0; camera < 2; ++camera) fill(history_->camera(camera), camera, 40);
  for (unsigned camera = 0; camera < 2; ++camera) {
    for (std::uint64_t trigger = 29; trigger <= 40; ++trigger) {
      const auto frame = reader_->tryPin(camera, trigger);
      ASSERT_TRUE(frame && frame->dma_buf.valid());
      EXPECT_EQ(frame->dma_buf.offset_bytes % kPageBytes, 0U);
      void* const mapped = mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, frame->dma_buf.fd,
                                static_cast<off_t>(frame->dma_buf.offset_bytes));
      ASSERT_NE(mapped, MAP_FAILED);
      EXPECT_EQ(*static_cast<const std::byte*>(mapped), mark(camera, trigger));
      munmap(mapped, kPageBytes);
    }
  }
}

TEST(PrivateHistory, HasNoDmaBufs) {
  auto history =
      FrameHistory::create({.frame_bytes = {kPageBytes}, .sets = 12, .in_flight = 3, .reserve = 4});
  ASSERT_TRUE(history);
  EXPECT_TRUE((*history)->notShared().empty());
  CameraFrames& frames = (*history)->camera(0);
  (void)frames.store(frames.fillingSlots()[0], {.trigger = 1});
  const auto frame = (*(*history)->openReader("test", 1))->tryPin(0, 1);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->dma_buf.valid());
}

}  // namespace
