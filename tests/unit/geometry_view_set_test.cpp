#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/geometry/coverage_text.h"
#include "appliance/geometry/view_set.h"

namespace {

using appliance::Rig;
using appliance::RigCamera;
using appliance::RigShelf;
using appliance::Sight;
using appliance::ViewSet;
using Eigen::Vector3d;
using testing::HasSubstr;
using testing::SizeIs;

/// Two cameras 4 m before the target, looking along +Y; the second one @p aside_m to the right.
Rig rigOf(double aside_m = 0.2) {
  Rig rig;
  rig.target_m = {0, 0, 1};
  rig.target_volume.half_size_m = {0.1, 0.1, 0.1};
  for (const double x_m : {0.0, aside_m}) {
    RigCamera camera{.name = x_m == 0 ? "left" : "right", .width_px = 1280, .height_px = 1024};
    camera.lens = {.fx_px = 1180, .fy_px = 1180, .cx_px = 639.5, .cy_px = 511.5, .max_radius = 10};
    camera.R_cam_rig << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    camera.t_cam_rig_m = {-x_m, 1, 4};
    rig.cameras.push_back(std::move(camera));
  }
  fillReferences(rig);
  return rig;
}

class Views : public testing::Test {
 protected:
  std::vector<std::byte> pixels = std::vector<std::byte>(std::size_t{1280} * 1024);
  hal::SourceImage source{.pixels = pixels.data(), .width_px = 1280, .height_px = 1024};
};

TEST_F(Views, HaveOneEdgeForAllCameras) {
  RigShelf shelf(rigOf());
  ViewSet views(1.0);
  views.update(shelf.newest(), 1920, 1080, {0, 0, 1});
  const auto left = views.plan(shelf.newest(), 0, source);
  const auto right = views.plan(shelf.newest(), 1, source);
  ASSERT_TRUE(left && right);
  EXPECT_TRUE(left->edge.active());
  EXPECT_EQ(left->edge, right->edge);
  EXPECT_NE(left->H_camera_display, right->H_camera_display);
}

TEST_F(Views, FollowTargetScreenAndRig) {
  RigShelf shelf(rigOf());
  ViewSet views(std::nullopt);
  views.update(shelf.newest(), 1920, 1080, {0, 0, 1});
  const double wide = views.zoom();
  const auto before = views.plan(shelf.newest(), 0, source);
  views.update(shelf.newest(), 1920, 1080, {0.05, 0, 1});
  EXPECT_NE(views.plan(shelf.newest(), 0, source)->H_camera_display, before->H_camera_display);
  EXPECT_EQ(views.zoom(), wide);
  views.update(shelf.newest(), 1080, 1920, {0, 0, 1});
  EXPECT_LT(views.zoom(), wide);
  ASSERT_TRUE(shelf.put(rigOf(0.5)));
  views.update(shelf.newest(), 1920, 1080, {0, 0, 1});
  EXPECT_GT(views.zoom(), wide);
}

TEST_F(Views, KeepAZoomThatIsANumber) {
  RigShelf shelf(rigOf());
  ViewSet views(1.3);
  views.update(shelf.newest(), 1920, 1080, {0, 0, 1});
  EXPECT_EQ(views.zoom(), 1.3);
  EXPECT_FALSE(views.cover());
}

TEST_F(Views, KnowWhichCameraDoesNotHaveTheTargetInItsPicture) {
  RigShelf shelf(rigOf());
  ViewSet views(std::nullopt);
  EXPECT_EQ(views.sight(1), Sight::kGood);
  views.update(shelf.newest(), 1920, 1080, {-2.1, 0, 1});
  EXPECT_EQ(views.sight(0), Sight::kPoor);
  EXPECT_EQ(views.sight(1), Sight::kNone);
}

TEST(CoverageText, NamesTheCameraThatNeedsTooMuch) {
  const Rig rig = rigOf();
  EXPECT_TRUE(coverWarning(rig, 1, 3.9).empty());
  EXPECT_EQ(textOf(coverWarning(rig, 1, 6.25)),
            "camera 2 (right) would need zoom 6.2 to fill the screen, 4.0 is used: aim it "
            "at the target, or make the rig's target_volume smaller");
  EXPECT_THAT(textOf(blindWarning(rig, 0)), HasSubstr("camera 1 (left) does not have the target"));
}

TEST(CoverageText, SaysZoomAndWhatEachCameraNeeds) {
  const auto lines = coverLines(rigOf(), 1920, 1080, std::nullopt);
  ASSERT_THAT(lines, SizeIs(4));
  EXPECT_THAT(lines[0], HasSubstr("screen of 1920x1080: zoom 1."));
  EXPECT_THAT(lines[2], HasSubstr("left"));
  const auto fixed = coverLines(rigOf(), 1920, 1080, 1.0);
  EXPECT_THAT(fixed[0], HasSubstr("zoom 1.00 as configured, \"cover\" is 1."));
}

}  // namespace
