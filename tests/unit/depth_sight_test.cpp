#include "appliance/depth/depth_sight.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/depth/depth_board.h"

namespace {

using appliance::DepthBoard;
using appliance::DepthSight;
using appliance::DepthSightReader;
using appliance::sightOf;

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;

std::vector<std::uint16_t> wall(std::uint16_t mm) {
  return std::vector<std::uint16_t>(std::size_t{kWidth} * kHeight, mm);
}

TEST(DepthSight, OfAWallIsItsDistance) {
  const DepthSight sight = sightOf(wall(3940), kWidth, kHeight);
  EXPECT_EQ(sight.measured_share, 1);
  EXPECT_DOUBLE_EQ(sight.middle_m.value_or(0), 3.94);
}

TEST(DepthSight, CountsHolesAndPassesOverThemInTheMiddle) {
  std::vector<std::uint16_t> depth_mm = wall(2000);
  for (std::size_t i = 0; i < depth_mm.size(); ++i)
    if (i % kWidth < kWidth / 2) depth_mm[i] = 0;
  const DepthSight sight = sightOf(depth_mm, kWidth, kHeight);
  EXPECT_DOUBLE_EQ(sight.measured_share, 0.5);
  EXPECT_DOUBLE_EQ(sight.middle_m.value_or(0), 2);
}

TEST(DepthSight, OfNothingHasNoMiddle) {
  EXPECT_FALSE(sightOf(wall(0), kWidth, kHeight).middle_m);
  EXPECT_EQ(sightOf({}, kWidth, kHeight).measured_share, 0) << "fewer pixels than its size says";
  EXPECT_EQ(sightOf({}, 0, 0).measured_share, 0);
}

TEST(DepthSight, IsThatOfTheNewestPictureAndStaysUntilTheNext) {
  DepthBoard board;
  DepthSightReader reader(**board.openReader("status", 1));
  EXPECT_FALSE(reader.look());
  for (const std::uint16_t mm : {std::uint16_t{1000}, std::uint16_t{2000}}) {
    const auto depth_mm = wall(mm);
    board.publish({.depth_mm = depth_mm, .width_px = kWidth, .height_px = kHeight});
  }
  EXPECT_DOUBLE_EQ(reader.look()->middle_m.value_or(0), 2);
  EXPECT_DOUBLE_EQ(reader.look()->middle_m.value_or(0), 2);
  EXPECT_EQ(board.readers().front().taken, 1u);
  EXPECT_EQ(board.readers().front().pinned, 0u);
}

}  // namespace
