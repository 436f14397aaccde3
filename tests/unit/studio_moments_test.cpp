#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "hal/emulated/studio/moment_store.h"

namespace {

using emulator::Overlay;
using emulator::studio::MomentPatches;
using emulator::studio::MomentStore;
using emulator::studio::packMoments;
using emulator::studio::Patch;

constexpr std::uint32_t kBlock = MomentStore::kBlock;

/// What two cameras see of a moment, another picture for every one.
MomentPatches patchesOf(std::uint32_t moment) {
  MomentPatches patches(2);
  for (std::uint32_t camera = 0; camera < 2; ++camera) {
    Patch& patch = patches[camera];
    patch.runs = {{.start = moment, .length = 3, .from = 0},
                  {.start = 100, .length = moment, .from = 3}};
    patch.pixels.resize(3 + moment);
    std::iota(patch.pixels.begin(), patch.pixels.end(), static_cast<std::uint8_t>(camera * 50));
  }
  return patches;
}

void expectSame(const Overlay& overlay, const Patch& patch) {
  const std::vector<std::uint8_t> pixels(overlay.pixels.begin(), overlay.pixels.end());
  EXPECT_EQ(pixels, patch.pixels);
  ASSERT_EQ(overlay.runs.size(), patch.runs.size());
  for (std::size_t i = 0; i < patch.runs.size(); ++i) {
    EXPECT_EQ(overlay.runs[i].start, patch.runs[i].start);
    EXPECT_EQ(overlay.runs[i].length, patch.runs[i].length);
    EXPECT_EQ(overlay.runs[i].from, patch.runs[i].from);
  }
}

/// Draws a turn that was taken; whether its block is complete.
bool draw(MomentStore& store, std::uint32_t turn) {
  store.patches(turn) = patchesOf(store.momentOf(turn));
  return store.finish(turn);
}

void drawBlock(MomentStore& store, std::uint32_t block) {
  for (std::uint32_t turn = block * kBlock; turn < (block + 1) * kBlock; ++turn)
    (void)draw(store, turn);
  ASSERT_TRUE(store.settle(block));
}

TEST(PackedMoments, HoldWhatWasPackedOneBehindTheOtherInOnePiece) {
  const std::vector<MomentPatches> moments = {patchesOf(1), patchesOf(40), {}, patchesOf(7)};
  const auto packed = packMoments(moments);
  ASSERT_TRUE(packed);
  ASSERT_EQ(packed->overlays.size(), moments.size());
  const auto bytes = packed->memory.bytes();
  for (std::size_t m = 0; m < moments.size(); ++m) {
    ASSERT_EQ(packed->overlays[m].size(), moments[m].size());
    for (std::size_t c = 0; c < moments[m].size(); ++c) {
      const Overlay& overlay = packed->overlays[m][c];
      expectSame(overlay, moments[m][c]);
      const auto* begin = reinterpret_cast<const std::byte*>(overlay.runs.data());
      EXPECT_GE(begin, bytes.data());
      EXPECT_LE(begin + overlay.runs.size_bytes(), bytes.data() + bytes.size());
    }
  }
}

TEST(PackedMoments, TakeMomentsInWhichNobodyIsSeen) {
  const auto packed = packMoments(std::vector<MomentPatches>{MomentPatches(2), MomentPatches(2)});
  ASSERT_TRUE(packed);
  EXPECT_TRUE(packed->overlays[1][1].runs.empty());
  EXPECT_FALSE(packed->overlays[1][1].touches(0, 1000));
}

TEST(MomentStore, GivesEveryTurnToOneDrawer) {
  MomentStore store({}, 8);
  for (std::uint32_t turn = 0; turn < 8; ++turn) EXPECT_EQ(store.take(), turn);
  EXPECT_FALSE(store.take());
}

TEST(MomentStore, GivesWhatWasGivenBackToTheNextDrawer) {
  MomentStore store({}, 8);
  (void)store.take();
  const auto second = store.take();
  (void)store.take();
  store.giveBack(*second);
  EXPECT_EQ(store.take(), second);
  EXPECT_EQ(store.take(), 3U);
}

TEST(MomentStore, MakesABlockReadyWhenItsLastTurnIsDrawn) {
  MomentStore store({}, 2 * kBlock);
  for (std::uint32_t turn = kBlock - 1; turn > 0; --turn) EXPECT_FALSE(draw(store, turn));
  EXPECT_EQ(store.ready(), 0U);
  EXPECT_TRUE(draw(store, 0));
  ASSERT_TRUE(store.settle(0));
  EXPECT_EQ(store.ready(), kBlock);
  for (std::uint32_t moment = 0; moment < kBlock; ++moment)
    for (std::uint32_t camera = 0; camera < 2; ++camera)
      expectSame(store.overlay(moment, camera), patchesOf(moment)[camera]);
}

TEST(MomentStore, LetsABlockWaitForTheOnesBeforeIt) {
  MomentStore store({}, 3 * kBlock);
  drawBlock(store, 1);
  EXPECT_EQ(store.ready(), 0U);
  drawBlock(store, 0);
  EXPECT_EQ(store.ready(), 2 * kBlock);
}

TEST(MomentStore, KeepsWhatIsReadyWhereItIs) {
  MomentStore store({}, 2 * kBlock);
  drawBlock(store, 0);
  const Overlay before = store.overlay(2, 1);
  drawBlock(store, 1);
  EXPECT_EQ(store.overlay(2, 1).pixels.data(), before.pixels.data());
  expectSame(before, patchesOf(2)[1]);
}

TEST(MomentStore, DrawsAFewChosenMomentsInTheOrderAskedFor) {
  MomentStore store({90, 17, 55}, 100);
  EXPECT_EQ(store.turns(), 3U);
  EXPECT_EQ(store.moments(), 100U);
  EXPECT_FALSE(draw(store, 0));
  EXPECT_FALSE(draw(store, 1));
  EXPECT_TRUE(draw(store, 2)) << "a last block may be short";
  ASSERT_TRUE(store.settle(0));
  EXPECT_EQ(store.ready(), 3U);
  expectSame(store.overlay(17, 0), patchesOf(17)[0]);
}

}  // namespace
