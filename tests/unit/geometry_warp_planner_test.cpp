#include <vector>

#include <gtest/gtest.h>

#include "appliance/geometry/warp_planner.h"

namespace {

using appliance::planWarp;
using appliance::RigCamera;
using appliance::View;

class WarpPlanner : public testing::Test {
 protected:
  RigCamera camera{.name = "cam01",
                   .width_px = 4,
                   .height_px = 2,
                   .lens = {.fx_px = 3, .fy_px = 3, .cx_px = 1.5, .cy_px = 0.5, .max_radius = 1},
                   .colour = {.gain_rgb = {1.5F, 1, 2}}};
  View view{.H_display_camera = {1, 0, 0, 0, 1, 0, 0, 0, 1},
            .H_camera_display = {1, 0, 5, 0, 1, 6, 0, 0, 1},
            .valid = true};
  std::vector<std::byte> pixels = std::vector<std::byte>(8);
  hal::SourceImage source{.pixels = pixels.data(), .width_px = 4, .height_px = 2};
};

TEST_F(WarpPlanner, HandsOverTheSourceTheBackwardHomographyAndTheCalibration) {
  const auto plan = planWarp(camera, view, source);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->source.pixels, pixels.data());
  EXPECT_EQ(plan->H_camera_display, view.H_camera_display);
  EXPECT_EQ(plan->lens.fx_px, 3);
  EXPECT_EQ(plan->lens.max_radius, 1);
  EXPECT_EQ(plan->colour, camera.colour);
}

TEST_F(WarpPlanner, RefusesAViewThatIsNotValid) {
  view.valid = false;
  EXPECT_FALSE(planWarp(camera, view, source).has_value());
}

TEST_F(WarpPlanner, RefusesAFrameOfAnotherSizeThanWasCalibrated) {
  source.width_px = 2;
  source.height_px = 4;
  EXPECT_FALSE(planWarp(camera, view, source).has_value());
}

TEST_F(WarpPlanner, RefusesASourceWithoutPixels) {
  source.pixels = nullptr;
  EXPECT_FALSE(planWarp(camera, view, source).has_value());
}

}  // namespace
