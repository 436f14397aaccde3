/// kagami-studio: looks at the studio scene without cameras or a box.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/depth_view.h"
#include "hal/emulated/studio/play.h"
#include "hal/emulated/studio/progress_bar.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/sensed_picture.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/shown.h"

namespace {

using namespace emulator::studio;

struct Arguments {
  StudioOptions studio;
  double second = 0;
  std::uint32_t camera = 10;
  std::string out;
  int columns = 5;
  int tile_px = 512;
};

/// For as long as it takes, as no emulator with cameras waiting for it would.
constexpr double kPatience_s = 1e6;

int fail(const std::string& message) {
  std::fprintf(stderr, "kagami-studio: %s\n", message.c_str());
  return 1;
}

int save(const std::string& path, const cv::Mat& bgr) {
  if (!cv::imwrite(path, bgr)) return fail("cannot write " + path);
  std::printf("%s: %d x %d\n", path.c_str(), bgr.cols, bgr.rows);
  return 0;
}

std::uint32_t momentOf(const Arguments& a) {
  return static_cast<std::uint32_t>(std::lround(a.second * kMoments_hz));
}

std::expected<std::unique_ptr<Play>, std::string> begin(Arguments& a) {
  if (a.studio.cache.empty()) a.studio.cache = usualCache();
  ProgressBar bar;
  return Play::begin(a.studio, [&bar](double share, const char* what) { bar.show(share, what); });
}

/// The one moment that is looked at.
std::expected<std::unique_ptr<Play>, std::string> open(Arguments& a) {
  a.studio.play_s = std::max(a.studio.play_s, a.second + 0.1);
  a.studio.only = {momentOf(a)};
  return begin(a);
}

/// The whole play into the cache.
int drawPlay(Arguments& a) {
  a.studio.first_play_s = a.studio.play_s;
  a.studio.patience_s = kPatience_s;
  const auto play = begin(a);
  if (!play) return fail(play.error());
  const double drawn_s = (*play)->readyCount() / kMoments_hz;
  std::printf("%.1f of %.1f s of the play are drawn: %s\n", drawn_s,
              (*play)->momentCount() / kMoments_hz, a.studio.cache.c_str());
  return (*play)->readyCount() == (*play)->momentCount() ? 0 : 1;
}

int makeSheet(Arguments& a) {
  auto play = open(a);
  if (!play) return fail(play.error());
  cv::Mat sheet;
  const int rows = (static_cast<int>(a.studio.cameras) + a.columns - 1) / a.columns;
  for (std::uint32_t camera = 0; camera < a.studio.cameras; ++camera) {
    const cv::Mat shown = shownPicture(**play, camera, momentOf(a));
    const cv::Size tile(a.tile_px, a.tile_px * shown.rows / shown.cols);
    if (sheet.empty())
      sheet = cv::Mat(rows * tile.height, a.columns * tile.width, CV_8UC3, cv::Scalar::all(0));
    const int i = static_cast<int>(camera);
    cv::Mat place = sheet(
        cv::Rect(i % a.columns * tile.width, i / a.columns * tile.height, tile.width, tile.height));
    cv::resize(shown, place, tile, 0, 0, cv::INTER_AREA);
  }
  return save(a.out, sheet);
}

int makeView(Arguments& a) {
  auto play = open(a);
  if (!play) return fail(play.error());
  if (a.camera < 1 || a.camera > a.studio.cameras) return fail("--camera counts from 1");
  return save(a.out, shownPicture(**play, a.camera - 1, momentOf(a)));
}

int makeDepth(const Arguments& a) {
  const auto depth = renderDepth(a.studio, a.camera - 1, a.second);
  if (!depth) return fail(depth.error());
  return save(a.out, colourDepth(*depth));
}

int makeSensed(Arguments& a) {
  a.studio.depth_sensor = true;
  a.studio.cameras = 1;
  const auto picture = static_cast<std::uint32_t>(std::lround(a.second * kDepth_hz));
  a.second = momentOfDepth(picture) / kMoments_hz;
  auto play = open(a);
  if (!play) return fail(play.error());
  return save(a.out, sensedPicture(**play, picture));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Looks at the studio scene.");
  app.require_subcommand(1);
  Arguments a;
  app.add_option("--seed", a.studio.seed)->capture_default_str();
  app.add_option("--cameras", a.studio.cameras)->capture_default_str()->check(CLI::Range(1, 250));
  app.add_option("--second", a.second, "of the play")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 600.0));
  app.add_option("--seconds", a.studio.play_s, "length of the play")->capture_default_str();
  app.add_option("--cache", a.studio.cache,
                 "folder that keeps the empty hall; default: kagami/studio in the user's cache");
  app.add_option("--camera", a.camera, "from 1")->capture_default_str();
  app.add_option("--out", a.out, "PNG or JPEG file, for all but draw");
  app.add_option("--columns", a.columns)->capture_default_str()->check(CLI::Range(1, 50));
  app.add_option("--tile", a.tile_px, "width of one picture of the sheet")
      ->capture_default_str()
      ->check(CLI::Range(16, 4096));
  app.add_flag("--depth-sensor", a.studio.depth_sensor, "what it sees, too, for draw");
  const CLI::App* draw =
      app.add_subcommand("draw", "the whole play into the cache: minutes, once")->fallthrough();
  CLI::App* sheet = app.add_subcommand("sheet", "one moment in all cameras")->fallthrough();
  CLI::App* view = app.add_subcommand("view", "one moment in one camera")->fallthrough();
  CLI::App* depth = app.add_subcommand("depth", "one camera's distances in colours")->fallthrough();
  CLI::App* sensed =
      app.add_subcommand("sensor", "what the depth sensor delivers: distances beside colour")
          ->fallthrough();
  CLI11_PARSE(app, argc, argv);
  if (*draw) return drawPlay(a);
  if (a.out.empty()) return fail("--out is missing: where the picture goes");
  if (*sheet) return makeSheet(a);
  if (*view) return makeView(a);
  if (*sensed) return makeSensed(a);
  return *depth ? makeDepth(a) : 1;
}
