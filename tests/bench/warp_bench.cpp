#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/bench/support/cpus.h"
#include "tests/bench/support/google.h"
#include "ui-kms/renderer.h"

// One view of a 1280x1024 Bayer camera on the screen: the product's renderer beside OpenCV, with as
// many threads. A software renderer takes its number of threads once per process, so each number of
// threads is a process.

namespace {

constexpr std::uint32_t kSourceWidthPx = 1280;
constexpr std::uint32_t kSourceHeightPx = 1024;

int opencv_threads = 1;  // of this process; set before the first benchmark

struct Scene {
  Scene(int width_px, int height_px) : display(width_px, height_px), mosaic(kSourcePixels) {
    for (std::size_t i = 0; i < mosaic.size(); ++i) {
      mosaic[i] = static_cast<std::byte>((i * 2654435761U) >> 24U);
    }
    plan.source = {mosaic.data(), kSourceWidthPx, kSourceHeightPx, hal::PixelFormat::kBayerRG8};
    const double scale = 0.9 * kSourceHeightPx / height_px;
    plan.H_camera_display = {scale, 0.05, 20, -0.03, scale, 60, 1e-5, 2e-5, 1};
    plan.lens = {1180, 1180, 639.5, 511.5, {-0.1, 0.02, 1e-3, 1e-3, 0}, 2};
  }

  /// Two cameras beside each other, each frame loaded again, as in a live comparison.
  [[nodiscard]] hal::Scene sideBySide() const {
    hal::Scene both = picture;
    both.count = 2;
    both.layers[1] = both.layers[0];
    both.layers[0].where = {0, 0, display.width / 2, display.height};
    both.layers[1].where = {display.width / 2, 0, display.width / 2, display.height};
    return both;
  }

  /// One camera through another, blended.
  [[nodiscard]] hal::Scene ghost() const {
    hal::Scene both = picture;
    both.count = 2;
    both.layers[1] = both.layers[0];
    both.layers[1].opacity = 0.5F;
    return both;
  }

  static constexpr std::size_t kSourcePixels = std::size_t{kSourceWidthPx} * kSourceHeightPx;
  cv::Size display;
  std::vector<std::byte> mosaic;
  hal::Scene picture{.count = 1};
  hal::WarpPlan& plan = picture.layers[0].plan;
};

Scene& sceneOf(const benchmark::State& state) {
  static std::map<std::int64_t, std::unique_ptr<Scene>> scenes;
  auto& scene = scenes[state.range(0)];
  if (!scene) {
    scene =
        std::make_unique<Scene>(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  }
  return *scene;
}

/// A renderer with its picture; made once, because that compiles shaders.
struct Screen {
  std::unique_ptr<ui::Renderer> renderer;
  std::optional<ui::RenderTarget> target;
  hal::Overlay overlay;  // a line of text on its plate
};

Screen* screenOf(const benchmark::State& state, std::string& error) {
  static std::map<std::int64_t, Screen> screens;
  Screen& screen = screens[state.range(0)];
  if (!screen.renderer) {
    const ui::RendererConfig config{.width_px = static_cast<std::uint32_t>(state.range(0)),
                                    .height_px = static_cast<std::uint32_t>(state.range(1)),
                                    .sources = {{kSourceWidthPx, kSourceHeightPx}}};
    auto renderer = ui::Renderer::create(config);
    if (!renderer) {
      error = renderer.error();
      return nullptr;
    }
    screen.renderer = std::move(*renderer);
    auto target = ui::makeRenderTarget(config.width_px, config.height_px);
    if (!target) {
      error = target.error();
      return nullptr;
    }
    screen.target = std::move(*target);
    if (hal::Typesetter* const typesetter = screen.renderer->typesetter()) {
      const auto height_px = static_cast<float>(config.height_px);
      typesetter->begin(screen.overlay);
      screen.overlay.add({.colour = {8, 10, 13, 158},
                          .x_px = 20,
                          .y_px = height_px - 85,
                          .width_px = 620,
                          .height_px = 65,
                          .radius_px = 16,
                          .stroke_px = 5});
      typesetter->set(
          screen.overlay, "delayed 1.50 s   camera 7",
          {.x_px = 40, .baseline_px = height_px - 40, .width_px = 1'000, .size_px = height_px / 18},
          {});
      typesetter->finish(screen.overlay);
    }
  }
  if (!screen.renderer->context().bind()) {
    error = "the context is not ours";
    return nullptr;
  }
  return &screen;
}

/// From the mosaic in memory to the finished picture, status line included.
void draw(benchmark::State& state, const hal::Scene& picture) {
  std::string error;
  Screen* screen = screenOf(state, error);
  if (screen == nullptr) {
    std::fprintf(stderr, "warp: %s\n", error.c_str());
    state.SkipWithError("no renderer");
    return;
  }
  hal::Scene scene = picture;
  scene.overlay = &screen->overlay;
  double warp_ns = 0;
  for (auto _ : state) {
    const auto instants = screen->renderer->draw(*screen->target, scene);
    warp_ns +=
        std::chrono::duration<double, std::nano>(instants.warp_end - instants.upload_end).count();
  }
  state.counters["warp"] = benchmark::Counter(warp_ns, benchmark::Counter::kAvgIterations);
  state.counters["gpu"] = screen->renderer->context().software() ? 0 : 1;
}

void ours(benchmark::State& state) {
  draw(state, sceneOf(state).picture);
}
void sideBySide(benchmark::State& state) {
  draw(state, sceneOf(state).sideBySide());
}
void ghost(benchmark::State& state) {
  draw(state, sceneOf(state).ghost());
}

/// What OpenCV works on; the demosaicing is its own, as it is ours on a software renderer.
struct OpenCvWarp {
  explicit OpenCvWarp(const Scene& scene)
      : mosaic(kSourceHeightPx, kSourceWidthPx, CV_8UC1,
               const_cast<std::byte*>(scene.mosaic.data())),
        to_camera(scene.plan.H_camera_display.data()),
        camera(scene.plan.lens.fx_px, 0, scene.plan.lens.cx_px, 0, scene.plan.lens.fy_px,
               scene.plan.lens.cy_px, 0, 0, 1),
        distortion(scene.plan.lens.distortion, /*copyData=*/true),
        display(scene.display) {
    cv::setNumThreads(opencv_threads);
    demosaic();
  }
  void demosaic() { cv::cvtColor(mosaic, rgb, cv::COLOR_BayerBG2RGB); }

  /// Undistorted, by maps that are made again for each picture, because each has its own
  /// homography.
  void remap() {
    // Its new camera matrix times rotation, inverted, is the way from display to ray.
    cv::initUndistortRectifyMap(camera, distortion, cv::noArray(), to_camera.inv() * camera,
                                display, CV_16SC2, map, weights);
    cv::remap(rgb, out, map, weights, cv::INTER_LINEAR);
  }
  /// Without undistortion.
  void warpPerspective() {
    cv::warpPerspective(rgb, out, to_camera, display, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  }

  cv::Mat mosaic;
  cv::Matx33d to_camera;
  cv::Matx33d camera;
  cv::Mat distortion;
  cv::Size display;
  cv::Mat rgb;
  cv::Mat map;
  cv::Mat weights;
  cv::Mat out;
};

void demosaicAndRemap(benchmark::State& state) {
  OpenCvWarp warp(sceneOf(state));
  for (auto _ : state) {
    warp.demosaic();
    warp.remap();
    benchmark::DoNotOptimize(warp.out.data);
  }
}

void remap(benchmark::State& state) {
  OpenCvWarp warp(sceneOf(state));
  for (auto _ : state) {
    warp.remap();
    benchmark::DoNotOptimize(warp.out.data);
  }
}

void demosaicAndWarpPerspective(benchmark::State& state) {
  OpenCvWarp warp(sceneOf(state));
  for (auto _ : state) {
    warp.demosaic();
    warp.warpPerspective();
    benchmark::DoNotOptimize(warp.out.data);
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({1280, 720})->Args({1920, 1080})->UseRealTime();
}
BENCHMARK(ours)->Apply(sizes);
BENCHMARK(sideBySide)->Apply(sizes);
BENCHMARK(ghost)->Apply(sizes);
BENCHMARK(demosaicAndRemap)->Apply(sizes);
BENCHMARK(remap)->Apply(sizes);
BENCHMARK(demosaicAndWarpPerspective)->Apply(sizes);

std::vector<bench::Comparison> compare(const bench::Repetitions& results, unsigned threads,
                                       bool all_cpus) {
  using Kind = bench::Bar::Kind;
  constexpr double kMillisecond = 1e6;
  const std::string with = ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  const auto samples = [&](const std::string& name, const char* as) {
    return results.samples(name, as, kMillisecond);
  };
  const auto on_gpu = results.samples("ours/1280/720:gpu", "").values;
  const bool gpu = !on_gpu.empty() && on_gpu.front() != 0;
  // The processor is what a GPU must beat with all it has; beside one thread it says nothing.
  // Judged is the warp: the mosaic's rows count the upload, too, which OpenCV does without.
  const bench::Bar bar =
      gpu ? bench::Bar{Kind::kRatioAtLeast, 3} : bench::Bar{Kind::kRatioAtMost, 2};
  const std::string not_judged = gpu && !all_cpus ? "one thread only" : "";
  std::vector<bench::Comparison> out;
  for (const char* size : {"1280/720", "1920/1080"}) {
    const std::string at = std::string("/") + size;
    const std::string rows = std::string(size).substr(std::string(size).find('/') + 1) + "p";
    out.push_back({.what = rows + with + ", from the mosaic",
                   .unit = "ms",
                   .ours = samples("ours" + at, gpu ? "EGL on a GPU" : "EGL on llvmpipe"),
                   .rival = samples("demosaicAndRemap" + at, "cvtColor, maps, remap"),
                   .as_speed = gpu});
    out.push_back({.what = rows + with + ", the warp alone",
                   .unit = "ms",
                   .ours = samples("ours" + at + ":warp", "mesh, warp, sRGB, text"),
                   .rival = samples("remap" + at, "maps, remap"),
                   .as_speed = gpu,
                   .bar = bar,
                   .not_judged = not_judged});
    out.push_back(
        {.what = rows + with + ", undistorted or not",
         .unit = "ms",
         .ours = samples("ours" + at, "ours, undistorts"),
         .rival = samples("demosaicAndWarpPerspective" + at, "warpPerspective, does not")});
  }
  out.push_back({.what = "720p" + with + ", two layers",
                 .unit = "ms",
                 .ours = samples("sideBySide/1280/720", "two cameras side by side"),
                 .rival = samples("ours/1280/720", "one camera"),
                 .bar = bench::Bar{Kind::kRatioAtMost, 1.7},
                 .not_judged = gpu ? "a GPU draws" : ""});
  out.push_back({.what = "720p" + with + ", a ghost",
                 .unit = "ms",
                 .ours = samples("ghost/1280/720", "two cameras, blended"),
                 .rival = samples("ours/1280/720", "one camera")});
  if (!gpu && all_cpus) {
    out.push_back({.what = "EGL on a GPU, all CPUs",
                   .unit = "ms",
                   .ours = {"EGL on a GPU", {}},
                   .bar = bench::Bar{Kind::kRatioAtLeast, 3},
                   .not_judged = "no GPU here"});
  }
  return out;
}

int runWith(unsigned threads, bool all_cpus, const std::vector<std::string>& arguments,
            const bench::Options& options) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), /*overwrite=*/1);
  opencv_threads = static_cast<int>(threads);
  bench::Repetitions results;
  if (!bench::runGoogleBenchmarks(arguments, options, results)) return 2;
  return bench::report("warp", compare(results, threads, all_cpus), options) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  const auto cpus = static_cast<unsigned>(bench::allowedCpus().size());
  std::vector<unsigned> thread_counts{1};
  if (cpus > 1) thread_counts.push_back(cpus);
  for (const unsigned threads : thread_counts) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const int code = runWith(threads, threads == thread_counts.back(), arguments, options);
      std::fflush(nullptr);
      _exit(code);  // the driver's threads end with the process
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return 1;
  }
  return 0;
}
