#include <array>

#include <gtest/gtest.h>

#include "appliance/render/composer.h"

namespace {

using appliance::arrange;
using appliance::Composition;
using appliance::Layout;
using appliance::placed;

hal::WarpPlan plan() {
  hal::WarpPlan plan;
  plan.H_camera_display = {1.1, 0.2, 30, -0.1, 0.9, 40, 1e-4, 2e-4, 1};
  return plan;
}

/// Where the camera is read for a pixel of the picture.
std::array<double, 2> readAt(const hal::WarpPlan& plan, double x_px, double y_px) {
  const auto& h = plan.H_camera_display;
  const double w = h[6] * x_px + h[7] * y_px + h[8];
  return {(h[0] * x_px + h[1] * y_px + h[2]) / w, (h[3] * x_px + h[4] * y_px + h[5]) / w};
}

TEST(Composer, ASingleViewIsThePlanItself) {
  const auto [places, count] = arrange({});
  ASSERT_EQ(count, 1U);
  const hal::ViewLayer layer = placed(plan(), 7, places[0], 1'280, 720);
  EXPECT_EQ(layer.plan.H_camera_display, plan().H_camera_display);
  EXPECT_EQ(layer.where, (hal::RectPx{0, 0, 1'280, 720}));
  EXPECT_EQ(layer.opacity, 1);
  EXPECT_EQ(layer.content, 7U);
}

TEST(Composer, SideBySideTheTargetStandsInTheMiddleOfEachHalf) {
  const auto [places, count] = arrange({.layout = Layout::kSideBySide});
  ASSERT_EQ(count, 2U);
  const auto middle = readAt(plan(), 640, 360);
  for (const std::size_t half : {0U, 1U}) {
    const hal::ViewLayer layer = placed(plan(), 1, places[half], 1'280, 720);
    const auto shown = readAt(layer.plan, half == 0 ? 320 : 960, 360);
    EXPECT_NEAR(shown[0], middle[0], 1e-9);
    EXPECT_NEAR(shown[1], middle[1], 1e-9);
  }
}

TEST(Composer, TheSharedEdgeStaysWithAViewThatIsNotMoved) {
  hal::WarpPlan edged = plan();
  edged.edge.narrowing = hal::EdgeMask::everywhere(1.5F);
  const auto beside = arrange({.layout = Layout::kSideBySide}).places;
  EXPECT_EQ(placed(edged, 1, beside[0], 1'280, 720).plan.edge, hal::EdgeMask{});
  const auto wiped = arrange({.layout = Layout::kWipe}).places;
  EXPECT_EQ(placed(edged, 1, wiped[0], 1'280, 720).plan.edge, edged.edge);
}

TEST(Composer, PlacesThatTouchShareTheirColumnWhateverTheWidth) {
  for (const std::uint32_t width_px : {1U, 2U, 719U, 1'080U, 1'281U}) {
    for (float share = 0; share <= 1; share += 0.0371F) {
      const auto [places, count] = arrange({.layout = Layout::kWipe, .share = share});
      ASSERT_EQ(count, 2U);
      const hal::RectPx first = placed(plan(), 1, places[0], width_px, 10).where;
      const hal::RectPx second = placed(plan(), 2, places[1], width_px, 10).where;
      EXPECT_EQ(first.x, 0);
      EXPECT_EQ(first.x + first.width, second.x);
      EXPECT_EQ(second.x + second.width, static_cast<std::int32_t>(width_px));
    }
  }
}

TEST(Composer, AGhostCoversThePictureAndLetsItThrough) {
  const auto [places, count] = arrange({.layout = Layout::kGhost, .share = 0.3F});
  ASSERT_EQ(count, 2U);
  const hal::ViewLayer ghost = placed(plan(), 1, places[1], 640, 360);
  EXPECT_EQ(ghost.where, (hal::RectPx{0, 0, 640, 360}));
  EXPECT_FLOAT_EQ(ghost.opacity, 0.3F);
  EXPECT_EQ(ghost.plan.H_camera_display, plan().H_camera_display);
}

}  // namespace
