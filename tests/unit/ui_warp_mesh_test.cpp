#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "ui-kms/warp_mesh.h"

namespace {

using ui::WarpMesh;

constexpr std::size_t kPerCell = 6;

hal::WarpPlan planOf(std::uint32_t width_px, std::uint32_t height_px) {
  hal::WarpPlan plan;
  plan.source.width_px = width_px;
  plan.source.height_px = height_px;
  plan.H_camera_display = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  plan.lens = {.fx_px = 100,
               .fy_px = 100,
               .cx_px = 50,
               .cy_px = 50,
               .max_radius = std::numeric_limits<double>::infinity()};
  return plan;
}

TEST(WarpMesh, CoversThePictureFromEdgeToEdge) {
  const WarpMesh mesh(100, 40);  // no multiple of a cell
  EXPECT_EQ(mesh.columnPx(0), -0.5);
  EXPECT_EQ(mesh.columnPx(mesh.columns() - 1), 99.5);
  EXPECT_EQ(mesh.rowPx(mesh.rows() - 1), 39.5);
}

TEST(WarpMesh, ASourceLargerThanTheDisplayNeedsNoPixelwiseCell) {
  WarpMesh mesh(128, 64);
  auto plan = planOf(200, 200);
  plan.H_camera_display[2] = 10;
  plan.H_camera_display[5] = 10;
  mesh.update(plan);
  EXPECT_EQ(mesh.innerIndices().size(), 4 * 2 * kPerCell);
  EXPECT_TRUE(mesh.edgeIndices().empty());
}

TEST(WarpMesh, ALayersCellsAreThoseThatItsRectangleTouches) {
  WarpMesh mesh(128, 64);
  auto plan = planOf(200, 200);
  plan.H_camera_display[2] = 10;
  plan.H_camera_display[5] = 10;
  mesh.update(plan,
              {40, 0, 30, 32});  // the second and third of four columns, the first of two rows
  EXPECT_EQ(mesh.innerIndices().size(), 2 * kPerCell);
  mesh.update(plan, {-5, 40, 6, 4'000});
  EXPECT_EQ(mesh.innerIndices().size(), 1 * kPerCell);
  mesh.update(plan, {128, 0, 10, 10});
  EXPECT_TRUE(mesh.innerIndices().empty());
  mesh.update(plan, {0, 0, 0, 10});
  EXPECT_TRUE(mesh.innerIndices().empty());
}

TEST(WarpMesh, CellsThatTheSourcesRimCrossesAreEvaluatedPerPixel) {
  WarpMesh mesh(128, 64);
  mesh.update(planOf(40, 200));               // its right rim lies in the second of four columns
  EXPECT_EQ(mesh.innerIndices().size(), 0U);  // the first row and column touch the rim as well
  EXPECT_EQ(mesh.edgeIndices().size(), 2 * 2 * kPerCell);
}

/// A picture that reaches half way from the centre to the display's edge: from 64 to 192 px across,
/// and from 32 to 96 px down.
hal::WarpPlan halfMasked() {
  auto plan = planOf(400, 400);
  plan.H_camera_display[2] = 10;
  plan.H_camera_display[5] = 10;
  plan.edge.narrowing = hal::EdgeMask::everywhere(2);
  return plan;
}

TEST(WarpMesh, CellsOutsideTheSharedEdgeAreNotDrawnAndThoseThatItCrossesAreSoft) {
  WarpMesh mesh(256, 128);
  auto plan = halfMasked();
  plan.edge.narrowing = hal::EdgeMask::everywhere(2.05F);
  mesh.update(plan);
  EXPECT_EQ(mesh.innerIndices().size(), 0U);
  EXPECT_EQ(mesh.softIndices().size(), 4 * 2 * kPerCell);
  EXPECT_TRUE(mesh.edgeIndices().empty());
  mesh.update(planOf(400, 400));
  EXPECT_TRUE(mesh.softIndices().empty()) << "the edge of the picture before it";
}

TEST(WarpMesh, ACellIsDrawnIfOnlyACornerOfTheSharedEdgeReachesIntoIt) {
  WarpMesh mesh(256, 128);
  auto plan = halfMasked();
  plan.edge.narrowing = hal::EdgeMask::everywhere(1'000);
  // To the right, in the middle of the screen's right side: a spike into the cells around it.
  plan.edge.narrowing[hal::EdgeMask::kPlacesPerSide * 3 / 2] = 1.2F;
  mesh.update(plan);
  const auto cellOf = [&mesh](std::size_t index) {
    return mesh.softIndices()[index] % mesh.columns();
  };
  ASSERT_FALSE(mesh.softIndices().empty());
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < mesh.softIndices().size(); i += kPerCell)
    farthest = std::max<std::size_t>(farthest, cellOf(i));
  EXPECT_EQ(farthest, 7U);  // 128 + 128 / 1.2 = 234 px
}

TEST(WarpMesh, WhereTheSourceEndsInsideTheSharedEdgeTheCellIsEvaluatedPerPixel) {
  WarpMesh mesh(256, 128);
  auto plan = halfMasked();
  plan.source.width_px = 130;  // ends at 120 px of the display
  mesh.update(plan);
  EXPECT_FALSE(mesh.edgeIndices().empty());
}

TEST(WarpMesh, BehindTheCameraThereIsNoCell) {
  WarpMesh mesh(128, 64);
  auto plan = planOf(200, 200);
  plan.H_camera_display[8] = -1;
  mesh.update(plan);
  EXPECT_TRUE(mesh.innerIndices().empty());
  EXPECT_TRUE(mesh.edgeIndices().empty());
}

TEST(WarpMesh, NumbersThatAreNoneMakeNoInnerCell) {
  WarpMesh mesh(128, 64);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    auto plan = planOf(200, 200);
    plan.H_camera_display[0] = bad;
    mesh.update(plan);
    EXPECT_TRUE(mesh.innerIndices().empty());
    plan = planOf(200, 200);
    plan.lens.fx_px = bad;
    mesh.update(plan);
    EXPECT_TRUE(mesh.innerIndices().empty());
  }
}

TEST(WarpMesh, BetweenItsCornersPerspectiveIsExact) {
  WarpMesh mesh(128, 64);
  auto plan = planOf(4'000, 4'000);
  plan.H_camera_display = {3, 0.2, 500, -0.1, 2.5, 400, 0.004, 0.002, 1};
  mesh.update(plan);
  ASSERT_FALSE(mesh.innerIndices().empty());
  const auto& a = mesh.vertices()[mesh.columns() + 1];
  const auto& b = mesh.vertices()[mesh.columns() + 2];
  const double x_px = (mesh.columnPx(1) + mesh.columnPx(2)) / 2;  // half way between a and b
  const double y_px = mesh.rowPx(1);
  const auto& h = plan.H_camera_display;
  const double u_px = (h[0] * x_px + h[1] * y_px + h[2]) / (h[6] * x_px + h[7] * y_px + h[8]);
  const double meshed_px =
      double{a.texture_u_w + b.texture_u_w} / double{a.texture_w + b.texture_w} * 4'000 - 0.5;
  EXPECT_NEAR(meshed_px, u_px, 1e-3);
}

}  // namespace
