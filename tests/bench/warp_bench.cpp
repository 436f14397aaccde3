#include <chrono>
#include <cstddef>
#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "ui-kms/cpu_demosaic.h"
#include "ui-kms/renderer.h"
#include "ui-kms/warp_mesh.h"

// One view of a 1280x1024 Bayer camera on the screen: the renderer, and what OpenCV needs for it.
// LP_NUM_THREADS in the environment sets the renderer's threads; OpenCV's peers have all CPUs.

namespace {

constexpr std::uint32_t kSourceWidthPx = 1280;
constexpr std::uint32_t kSourceHeightPx = 1024;

struct Scene {
  Scene(int width_px, int height_px) : display(width_px, height_px), mosaic(kSourcePixels) {
    for (std::size_t i = 0; i < mosaic.size(); ++i) {
      mosaic[i] = static_cast<std::byte>((i * 2654435761U) >> 24U);
    }
    plan.source = {mosaic.data(), kSourceWidthPx, kSourceHeightPx, hal::PixelFormat::kBayerRG8};
    const double scale = 0.9 * kSourceHeightPx / height_px;
    plan.H_camera_display = {scale, 0.05, 20, -0.03, scale, 60, 1e-5, 2e-5, 1};
    plan.lens = {1180, 1180, 639.5, 511.5, {-0.1, 0.02, 1e-3, 1e-3, 0}, 2};
    std::strncpy(status.text.data(), "delayed 1.50 s   camera 7", status.text.size() - 1);
  }

  static constexpr std::size_t kSourcePixels = std::size_t{kSourceWidthPx} * kSourceHeightPx;
  cv::Size display;
  std::vector<std::byte> mosaic;
  hal::WarpPlan plan;
  hal::StatusLine status;
};

Scene sceneOf(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
}

void render(benchmark::State& state, ui::DemosaicSite site) {
  const Scene scene = sceneOf(state);
  ui::RendererConfig config;
  config.width_px = static_cast<std::uint32_t>(scene.display.width);
  config.height_px = static_cast<std::uint32_t>(scene.display.height);
  config.source_width_px = kSourceWidthPx;
  config.source_height_px = kSourceHeightPx;
  config.demosaic = site;
  const auto renderer = ui::Renderer::create(config);
  if (!renderer) {
    state.SkipWithError(renderer.error().c_str());
    return;
  }
  const ui::RenderTarget target = ui::makeRenderTarget(config.width_px, config.height_px);
  double upload_ms = 0;
  double warp_ms = 0;
  for (auto _ : state) {
    const auto instants = (*renderer)->draw(target, &scene.plan, scene.status);
    using Milliseconds = std::chrono::duration<double, std::milli>;
    upload_ms += Milliseconds(instants.upload_end - instants.warp_submit).count();
    warp_ms += Milliseconds(instants.warp_end - instants.upload_end).count();
  }
  state.counters["demosaic_upload_ms"] =
      benchmark::Counter(upload_ms, benchmark::Counter::kAvgIterations);
  state.counters["warp_ms"] = benchmark::Counter(warp_ms, benchmark::Counter::kAvgIterations);
  state.SetLabel((*renderer)->context().renderer());
}

void renderCpuDemosaic(benchmark::State& state) {
  render(state, ui::DemosaicSite::kCpu);
}
void renderShaderDemosaic(benchmark::State& state) {
  render(state, ui::DemosaicSite::kGpu);
}

void demosaic(benchmark::State& state) {
  const Scene scene = sceneOf(state);
  std::vector<std::byte> rgba(Scene::kSourcePixels * 4);
  for (auto _ : state) ui::demosaicOnCpu(scene.plan.source, rgba);
}

void warpMesh(benchmark::State& state) {
  const Scene scene = sceneOf(state);
  ui::WarpMesh mesh(static_cast<std::uint32_t>(scene.display.width),
                    static_cast<std::uint32_t>(scene.display.height));
  for (auto _ : state) mesh.update(scene.plan);
}

/// Undistorted by maps that are made anew for each picture, because each has its own homography.
void openCvRemap(benchmark::State& state) {
  cv::setNumThreads(cv::getNumberOfCPUs());
  const Scene scene = sceneOf(state);
  const auto& lens = scene.plan.lens;
  const cv::Mat mosaic(kSourceHeightPx, kSourceWidthPx, CV_8UC1,
                       const_cast<std::byte*>(scene.mosaic.data()));
  const cv::Matx33d camera(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
  const cv::Matx33d to_camera(scene.plan.H_camera_display.data());
  const cv::Mat distortion(lens.distortion, /*copyData=*/true);
  cv::Mat rgb;
  cv::Mat map;
  cv::Mat weights;
  cv::Mat out;
  for (auto _ : state) {
    cv::cvtColor(mosaic, rgb, cv::COLOR_BayerBG2RGB);
    // Its new camera matrix times rotation, inverted, is the way from display to ray.
    cv::initUndistortRectifyMap(camera, distortion, cv::noArray(), to_camera.inv() * camera,
                                scene.display, CV_16SC2, map, weights);
    cv::remap(rgb, out, map, weights, cv::INTER_LINEAR);
    benchmark::DoNotOptimize(out.data);
  }
}

/// Without undistortion.
void openCvWarpPerspective(benchmark::State& state) {
  cv::setNumThreads(cv::getNumberOfCPUs());
  const Scene scene = sceneOf(state);
  const cv::Mat mosaic(kSourceHeightPx, kSourceWidthPx, CV_8UC1,
                       const_cast<std::byte*>(scene.mosaic.data()));
  const cv::Matx33d to_camera(scene.plan.H_camera_display.data());
  cv::Mat rgb;
  cv::Mat out;
  for (auto _ : state) {
    cv::cvtColor(mosaic, rgb, cv::COLOR_BayerBG2RGB);
    cv::warpPerspective(rgb, out, to_camera, scene.display,
                        cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    benchmark::DoNotOptimize(out.data);
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"width", "height"})->Args({1280, 720})->Args({1920, 1080});
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(renderCpuDemosaic)->Apply(sizes);
BENCHMARK(renderShaderDemosaic)->Apply(sizes);
BENCHMARK(demosaic)->Apply(sizes);
BENCHMARK(warpMesh)->Apply(sizes);
BENCHMARK(openCvRemap)->Apply(sizes);
BENCHMARK(openCvWarpPerspective)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
