#include <array>
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "appliance/geometry/homography.h"

namespace {

/// Twenty cameras on a half circle of 4 m around the target, one metre up.
appliance::Rig arcOfTwenty() {
  appliance::Rig rig;
  rig.target_m = {0, 0, 1};
  for (int i = 0; i < 20; ++i) {
    appliance::RigCamera camera;
    camera.width_px = 1280;
    camera.height_px = 1024;
    camera.lens = {.fx_px = 1180, .fy_px = 1180, .cx_px = 639.5, .cy_px = 511.5};
    const double angle = std::numbers::pi * i / 19;
    const Eigen::Vector3d sight{std::cos(angle), std::sin(angle), 0};
    camera.R_cam_rig.row(0) = Eigen::Vector3d(sight.y(), -sight.x(), 0);
    camera.R_cam_rig.row(1) = Eigen::Vector3d(0, 0, -1);
    camera.R_cam_rig.row(2) = sight;
    camera.t_cam_rig_m = -(camera.R_cam_rig * (rig.target_m - 4 * sight));
    rig.cameras.push_back(camera);
  }
  appliance::fillReferences(rig);
  return rig;
}

/// The views of a whole rig for a target that moves; at most 10 us are allowed.
void homographiesOfTwentyCameras(benchmark::State& state) {
  const appliance::Rig rig = arcOfTwenty();
  std::array<appliance::View, 20> views;
  Eigen::Vector3d target_m = rig.target_m;
  for (auto _ : state) {
    target_m.x() = -target_m.x() + 0.01;
    appliance::computeViews(rig, target_m, {.width_px = 1280, .height_px = 720, .zoom = 1}, views);
    benchmark::DoNotOptimize(views);
  }
}
BENCHMARK(homographiesOfTwentyCameras);

}  // namespace

BENCHMARK_MAIN();
