#include <gtest/gtest.h>

#include "appliance/director/composition.h"

namespace {

using appliance::arrange;
using appliance::Layout;

TEST(Composition, OneShotFillsThePicture) {
  const auto arranged = arrange({});
  EXPECT_EQ(arranged.count, 1u);
  EXPECT_EQ(arranged.places[0], appliance::Place{});
}

TEST(Composition, SideBySideCutsThePictureInHalvesWithATargetInEach) {
  const auto arranged = arrange({.layout = Layout::kSideBySide});
  ASSERT_EQ(arranged.count, 2u);
  EXPECT_EQ(arranged.places[0].left, 0);
  EXPECT_EQ(arranged.places[0].right, arranged.places[1].left);
  EXPECT_EQ(arranged.places[1].right, 1);
  for (const auto& place : {arranged.places[0], arranged.places[1]})
    EXPECT_EQ(place.centre, (place.left + place.right) / 2);
}

TEST(Composition, AGhostLiesOverTheWholeFirstShot) {
  const auto arranged = arrange({.layout = Layout::kGhost, .share = 0.25F});
  EXPECT_EQ(arranged.places[0], appliance::Place{});
  EXPECT_EQ(arranged.places[1].opacity, 0.25F);
  EXPECT_EQ(arrange({.layout = Layout::kGhost, .share = 7}).places[1].opacity, 1);
}

TEST(Composition, AWipeLeavesNoGapAndMovesNoTarget) {
  const auto arranged = arrange({.layout = Layout::kWipe, .share = 0.3F});
  EXPECT_EQ(arranged.places[0].right, arranged.places[1].left);
  EXPECT_EQ(arranged.places[0].centre, arranged.places[1].centre);
}

TEST(Composition, LayoutsHaveNames) {
  for (const auto& row : appliance::kLayouts)
    EXPECT_EQ(appliance::layoutNamed(row.name), row.layout);
  EXPECT_FALSE(appliance::layoutNamed("both").has_value());
}

}  // namespace
