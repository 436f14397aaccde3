// Where the picture ends while the views of the studio's twenty cameras pass by and the target
// moves. The frames are white: only the edge is looked at, the hall is not drawn.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/geometry/rig_file.h"
#include "appliance/geometry/view_set.h"
#include "hal/emulated/studio/studio_rig.h"
#include "tests/golden/golden_display.h"
#include "tests/golden/picture_edge.h"

namespace {

using appliance::Rig;
using appliance::RigShelf;
using appliance::Sight;
using appliance::ViewSet;
using Eigen::Vector3d;

constexpr std::uint32_t kCameras = 20;
constexpr int kSteps = 40;  // two sweeps
constexpr emulator::SizePx kFrame{1280, 1024};

/// As the demo of the studio calibrates it, but with equal colours.
Rig studioRig() {
  const auto studio = emulator::studio::makeStudioRig(kCameras, kFrame, /*seed=*/1);
  auto rig = appliance::parseRig(toToml(studio.model()), "studio");
  EXPECT_TRUE(rig.has_value()) << rig.error();
  for (auto& camera : rig->cameras) camera.colour = {};
  return *rig;
}

/// Turns about the middle of the target volume, out to its wall and back, and from its floor to its
/// ceiling.
Vector3d targetAt(const Rig& rig, int step) {
  const double part = static_cast<double>(step) / (kSteps - 1);
  const double angle = 2 * std::numbers::pi * 4 * part;
  const double out = std::sin(2 * std::numbers::pi * 2.5 * part);
  const Vector3d middle_m = rig.target_volume.centre_m.value_or(rig.target_m);
  return middle_m + rig.target_volume.half_size_m.cwiseProduct(
                        Vector3d(out * std::cos(angle), out * std::sin(angle), 2 * part - 1));
}

class StudioEdgeGolden : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(display_, nullptr); }

  /// The edges of a camera's view of that target, or its own alone, without the shared edge.
  std::vector<double> edges(std::uint32_t camera, const Vector3d& target_m, ViewSet& views,
                            bool own = false) {
    const auto rig = shelf_.newest();
    views.update(rig, static_cast<std::uint32_t>(kDisplay.width),
                 static_cast<std::uint32_t>(kDisplay.height), target_m);
    EXPECT_EQ(views.sight(camera), Sight::kGood) << "camera " << camera;
    auto plan =
        views.plan(rig, camera,
                   {.pixels = white_.data(), .width_px = kFrame.width, .height_px = kFrame.height});
    EXPECT_TRUE(plan);
    if (!plan) return std::vector<double>(12);
    if (own) plan->edge = {};
    hal::Scene scene;
    scene.layers[scene.count++] = {.plan = *plan, .content = 1};  // every frame is the same
    return edgesOf(shownScene(*display_, scene));
  }

  RigShelf shelf_{studioRig()};
  std::unique_ptr<ui::OffscreenDisplay> display_ = makeDisplay();
  std::vector<std::byte> white_ =
      std::vector<std::byte>(std::size_t{kFrame.width} * kFrame.height, std::byte{255});
};

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t line = 0; line < a.size(); ++line)
    most = std::max(most, std::abs(a[line] - b[line]));
  return most;
}

TEST_F(StudioEdgeGolden, StaysWithinAPixelFromViewToViewWhereverTheTargetIs) {
  ViewSet views(1.4);  // the demo's zoom
  double by_view_px = 0;
  double by_target_px = 0;
  std::optional<std::vector<double>> before;
  for (int step = 0; step < kSteps; ++step) {
    const Vector3d target_m = targetAt(*shelf_.newest(), step);
    const auto camera = static_cast<std::uint32_t>(step) % kCameras;
    const auto here = edges(camera, target_m, views);
    const auto next = edges((camera + 1) % kCameras, target_m, views);
    const double moved_px = farthest(here, next);
    EXPECT_LE(moved_px, 1) << "from camera " << camera << " to its neighbour, step " << step;
    by_view_px = std::max(by_view_px, moved_px);
    if (before) by_target_px = std::max(by_target_px, farthest(*before, here));
    before = next;
  }
  std::printf("a change of view moves the edge by %.2f px at most, a moving target by %.1f px\n",
              by_view_px, by_target_px);
  // The test would see nothing if the views' own edges lay in one place.
  const Vector3d target_m = targetAt(*shelf_.newest(), 0);
  double own_px = 0;
  for (std::uint32_t camera = 0; camera + 1 < kCameras; ++camera) {
    own_px = std::max(own_px, farthest(edges(camera, target_m, views, /*own=*/true),
                                       edges(camera + 1, target_m, views, /*own=*/true)));
  }
  std::printf("without the shared edge by %.1f px\n", own_px);
  EXPECT_GT(own_px, 10);
}

TEST_F(StudioEdgeGolden, IsNeverSeenAtCoverZoomWhileTheTargetIsInItsVolume) {
  ViewSet views(std::nullopt);
  for (int step = 0; step < kSteps; ++step) {
    const auto camera = static_cast<std::uint32_t>(step) % kCameras;
    const auto here = edges(camera, targetAt(*shelf_.newest(), step), views);
    for (std::size_t line = 0; line < here.size(); line += 4) {
      EXPECT_EQ(here[line], 0) << "left, camera " << camera << ", step " << step;
      EXPECT_EQ(here[line + 1], 0) << "upper, camera " << camera << ", step " << step;
      EXPECT_EQ(here[line + 2], kDisplay.width - 1) << "right, camera " << camera;
      EXPECT_EQ(here[line + 3], kDisplay.height - 1) << "lower, camera " << camera;
    }
  }
  std::printf("cover zoom %.3f\n", views.zoom());
}

}  // namespace
