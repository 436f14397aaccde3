#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "appliance/geometry/homography.h"
#include "tests/bench/support/google.h"

// The constant views of twenty cameras for a target that moves: the product's closed form, and the
// formula of docs/architecture.md written down with OpenCV's matrices.

namespace {

constexpr std::size_t kCameras = 20;
constexpr appliance::ViewParameters kParameters{.width_px = 1280, .height_px = 720, .zoom = 1};

/// Twenty cameras on a half circle of 4 m around the target, one metre up.
appliance::Rig arcOfTwenty() {
  appliance::Rig rig;
  rig.target_m = {0, 0, 1};
  for (std::size_t i = 0; i < kCameras; ++i) {
    appliance::RigCamera camera;
    camera.width_px = 1280;
    camera.height_px = 1024;
    camera.lens = {.fx_px = 1180, .fy_px = 1180, .cx_px = 639.5, .cy_px = 511.5};
    const double angle = std::numbers::pi * static_cast<double>(i) / (kCameras - 1);
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

struct OpenCvCamera {
  cv::Matx33d A;
  cv::Matx33d R;
  cv::Vec3d centre_m;
};

std::vector<OpenCvCamera> openCvCamerasOf(const appliance::Rig& rig) {
  std::vector<OpenCvCamera> cameras;
  for (const appliance::RigCamera& camera : rig.cameras) {
    const hal::Lens& lens = camera.lens;
    OpenCvCamera out;
    out.A = {lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        out.R(row, column) = camera.R_cam_rig(row, column);
      }
    }
    const Eigen::Vector3d centre_m = camera.centre_m();
    out.centre_m = {centre_m.x(), centre_m.y(), centre_m.z()};
    cameras.push_back(out);
  }
  return cameras;
}

/// H_camera_display: the inverse of A'_m R'_m R_m^-1 A_m^-1.
cv::Matx33d openCvView(const OpenCvCamera& camera, const appliance::Rig& rig,
                       const cv::Vec3d& target_m) {
  const cv::Vec3d sight = target_m - camera.centre_m;
  const double distance_m = cv::norm(sight);
  const cv::Vec3d e_z = sight / distance_m;
  const cv::Vec3d e_x = cv::normalize(e_z.cross(cv::Vec3d(0, 0, 1)));
  const cv::Vec3d e_y = e_z.cross(e_x);
  const cv::Matx33d R_view(e_x[0], e_x[1], e_x[2], e_y[0], e_y[1], e_y[2], e_z[0], e_z[1], e_z[2]);
  const double k = kParameters.height_px / rig.reference_height_px;
  const double f = k * rig.reference_focal_px * distance_m / rig.reference_distance_m;
  const cv::Matx33d A_view(f, 0, (kParameters.width_px - 1.0) / 2, 0, f,
                           (kParameters.height_px - 1.0) / 2, 0, 0, 1);
  const cv::Matx33d H_display_camera = A_view * R_view * camera.R.inv() * camera.A.inv();
  return H_display_camera.inv();
}

void ours(benchmark::State& state) {
  const appliance::Rig rig = arcOfTwenty();
  std::array<appliance::View, kCameras> views;
  Eigen::Vector3d target_m = rig.target_m;
  for (auto _ : state) {
    target_m.x() = -target_m.x() + 0.01;
    appliance::computeViews(rig, target_m, kParameters, views);
    benchmark::DoNotOptimize(views);
  }
}
BENCHMARK(ours)->UseRealTime();

void openCv(benchmark::State& state) {
  const appliance::Rig rig = arcOfTwenty();
  const std::vector<OpenCvCamera> cameras = openCvCamerasOf(rig);
  std::array<cv::Matx33d, kCameras> views;
  cv::Vec3d target_m{rig.target_m.x(), rig.target_m.y(), rig.target_m.z()};
  for (auto _ : state) {
    target_m[0] = -target_m[0] + 0.01;
    for (std::size_t m = 0; m < kCameras; ++m) views[m] = openCvView(cameras[m], rig, target_m);
    benchmark::DoNotOptimize(views);
  }
}
BENCHMARK(openCv)->UseRealTime();

/// A rival that computes something else is no rival.
bool bothAgree() {
  const appliance::Rig rig = arcOfTwenty();
  const std::vector<OpenCvCamera> cameras = openCvCamerasOf(rig);
  const Eigen::Vector3d target_m{0.3, -0.2, 1.1};
  for (std::size_t m = 0; m < kCameras; ++m) {
    const auto view = appliance::viewOf(rig.cameras[m], rig, target_m, kParameters);
    const cv::Matx33d rival = openCvView(cameras[m], rig, {0.3, -0.2, 1.1});
    const double scale = view.H_camera_display[8] / rival.val[8];
    for (std::size_t i = 0; i < 9; ++i) {
      if (std::abs(view.H_camera_display[i] - scale * rival.val[i]) > 1e-6) return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  if (!bothAgree()) {
    std::fputs("homographies: ours and OpenCV's differ\n", stderr);
    return 1;
  }
  bench::Repetitions results;
  if (!bench::runGoogleBenchmarks(arguments, options, results)) return 2;
  const bench::Samples own = results.samples("ours", "closed form", 1e3);
  const std::vector<bench::Comparison> comparisons{
      {.what = "20 cameras",
       .unit = "us",
       .ours = own,
       .rival = results.samples("openCv", "OpenCV's matrices", 1e3),
       .bar = bench::Bar{bench::Bar::Kind::kOursAtMost, 10}}};
  return bench::report("homographies", comparisons, options) ? 0 : 1;
}
