#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "appliance/geometry/lens.h"
#include "appliance/geometry/view_set.h"
#include "tests/golden/golden_display.h"
#include "tests/golden/picture_edge.h"

namespace {

using appliance::Rig;
using appliance::RigCamera;
using appliance::RigShelf;
using appliance::Sight;
using appliance::ViewSet;
using Eigen::Vector3d;

constexpr std::uint32_t kCameras = 8;

/// Cameras on half a circle of 4 m, each a little beside its aim, rolled and with a lens.
Rig arc() {
  Rig rig;
  rig.target_m = {0, 0, 1};
  rig.target_volume.half_size_m = {0.1, 0.1, 0.1};
  for (std::uint32_t i = 0; i < kCameras; ++i) {
    const double angle = std::numbers::pi * i / (kCameras - 1);
    const Vector3d centre_m{4 * std::cos(angle), -4 * std::sin(angle), 1.2};
    const Vector3d aim_m =
        rig.target_m + 0.15 * Vector3d(std::sin(2.0 * i), std::cos(3.0 * i), std::sin(5.0 * i));
    const Vector3d sight = (aim_m - centre_m).normalized();
    RigCamera camera{.name = "cam" + std::to_string(i + 1), .width_px = 1280, .height_px = 1024};
    camera.lens = {.fx_px = 1180, .fy_px = 1180, .cx_px = 645, .cy_px = 505};
    camera.lens.distortion = {-0.1, 0.02, 0.001, -0.001, 0};
    camera.lens.max_radius = appliance::maxRadius(camera.lens, 1280, 1024);
    camera.R_cam_rig.row(0) = sight.cross(Vector3d::UnitZ()).normalized();
    camera.R_cam_rig.row(1) = sight.cross(camera.R_cam_rig.row(0).transpose());
    camera.R_cam_rig.row(2) = sight;
    camera.R_cam_rig =
        Eigen::AngleAxisd(0.03 * std::cos(7.0 * i), Vector3d::UnitZ()) * camera.R_cam_rig;
    camera.t_cam_rig_m = -(camera.R_cam_rig * centre_m);
    rig.cameras.push_back(std::move(camera));
  }
  fillReferences(rig);
  return rig;
}

class SharedEdgeGolden : public testing::Test {
 protected:
  /// The edges of every view of white frames.
  std::vector<std::vector<double>> sweep(ViewSet& views, const Vector3d& target_m) {
    RigShelf shelf(arc());
    const auto rig = shelf.newest();
    const auto display = makeDisplay();
    if (display == nullptr) return {};
    const std::vector<std::byte> white(std::size_t{1280} * 1024, std::byte{255});
    const hal::SourceImage source{.pixels = white.data(), .width_px = 1280, .height_px = 1024};
    views.update(rig, static_cast<std::uint32_t>(kDisplay.width),
                 static_cast<std::uint32_t>(kDisplay.height), target_m);
    std::vector<std::vector<double>> edges;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      EXPECT_EQ(views.sight(camera), Sight::kGood);
      const auto plan = views.plan(rig, camera, source);
      EXPECT_TRUE(plan);
      if (plan) edges.push_back(edgesOf(shown(*display, &*plan)));
    }
    return edges;
  }
};

TEST_F(SharedEdgeGolden, DoesNotMoveByAPixelInASweepOverAllViews) {
  ViewSet views(1.0);
  const auto edges = sweep(views, {0.3, 0.2, 1.1});
  ASSERT_EQ(edges.size(), kCameras);
  double farthest = 0;
  for (std::size_t line = 0; line < edges[0].size(); ++line) {
    for (const auto& view : edges)
      farthest = std::max(farthest, std::abs(view[line] - edges[0][line]));
  }
  RecordProperty("farthest_px", std::to_string(farthest));
  EXPECT_LE(farthest, 1);
  // The test would see nothing without an edge on the screen.
  EXPECT_GT(edges[0][0], 20);
}

TEST_F(SharedEdgeGolden, LiesOutsideTheScreenAtCoverZoom) {
  ViewSet views(std::nullopt);
  for (const auto& view : sweep(views, {0.05, 0.05, 1.05})) {
    for (std::size_t line = 0; line < view.size(); line += 4) {
      EXPECT_EQ(view[line], 0);
      EXPECT_EQ(view[line + 1], 0);
      EXPECT_EQ(view[line + 2], kDisplay.width - 1);
      EXPECT_EQ(view[line + 3], kDisplay.height - 1);
    }
  }
}

}  // namespace
