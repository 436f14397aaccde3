#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/reception/round.h"
#include "tests/bench/support/comparison.h"

// How the cost of reception grows: with the number of cameras, and not with the history's length.
// Small pictures, so that even forty cameras leave the machine room.

namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kWidthPx = 640;
constexpr std::uint32_t kHeightPx = 480;
constexpr double kRate_hz = 30;

/// CPU seconds per second of capture, round by round, at each abscissa.
struct Curve {
  std::string name;
  bench::Contestant contestant;
  std::vector<std::vector<double>> cpu = {};
};

bool measure(const bench::ReceptionSetup& setup, Curve& curve, std::size_t at,
             std::chrono::milliseconds length) {
  const auto result = bench::runRound(setup, curve.contestant, length);
  if (!result) {
    std::fprintf(stderr, "growth: %s: %s\n", curve.name.c_str(), result.error().c_str());
    return false;
  }
  if (!result->valid()) {
    std::printf("    %s, %zu cameras: a round lost %.1f %% of its frames and does not count%s%s\n",
                curve.name.c_str(), setup.cameras.size(),
                100 - 100.0 * static_cast<double>(result->frames) /
                          static_cast<double>(std::max<std::uint64_t>(result->expected, 1)),
                result->stalls.empty() ? "" : ": ", result->stalls.c_str());
    return true;
  }
  curve.cpu[at].push_back(result->cpu_s / result->wall_s);
  return true;
}

struct Line {
  double slope = 0;
  double offset = 0;
  double r2 = 0;
};

/// Least squares.
Line fit(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [px, py] : points) {
    n += 1;
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
  }
  Line line;
  if (n < 2) return line;
  line.slope = (n * xy - x * y) / (n * xx - x * x);
  line.offset = (y - line.slope * x) / n;
  double residual = 0, total = 0;
  for (const auto& [px, py] : points) {
    residual += std::pow(py - line.offset - line.slope * px, 2);
    total += std::pow(py - y / n, 2);
  }
  line.r2 = total > 0 ? 1 - residual / total : 0;
  return line;
}

std::vector<std::pair<double, double>> medians(const std::vector<std::uint32_t>& at,
                                               const Curve& curve) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!curve.cpu[i].empty()) points.emplace_back(at[i], bench::figuresOf(curve.cpu[i]).median);
  }
  return points;
}

/// A block of lines per curve, as gnuplot's `index` takes them.
bool write(const std::filesystem::path& file, const std::vector<std::uint32_t>& at,
           const std::vector<Curve>& curves) {
  std::ofstream out(file);
  for (const Curve& curve : curves) {
    out << '"' << curve.name << "\"\n";
    for (const auto& [x, y] : medians(at, curve)) out << x << ' ' << y << '\n';
    out << "\n\n";
  }
  out.flush();
  return static_cast<bool>(out);
}

struct Plan {
  std::vector<std::uint32_t> cameras;
  std::vector<std::uint32_t> sets;
  std::uint32_t history_cameras;
  int rounds;
  std::chrono::milliseconds length;
};

bool growWithCameras(const Plan& plan, std::vector<Curve>& curves) {
  const bench::EmulatedRig rig(plan.cameras.back(), kWidthPx, kHeightPx);
  if (!rig.ready()) {
    std::fprintf(stderr, "growth: %s\n", rig.error().c_str());
    return false;
  }
  for (Curve& curve : curves) curve.cpu.resize(plan.cameras.size());
  for (int round = 0; round < plan.rounds; ++round) {
    for (std::size_t i = 0; i < plan.cameras.size(); ++i) {
      // Up and down in turns: what drifts over the run is no growth.
      const std::size_t at = round % 2 == 0 ? i : plan.cameras.size() - 1 - i;
      for (Curve& curve : curves) {
        if (!measure(rig.setup(plan.cameras[at], kRate_hz), curve, at, plan.length)) return false;
      }
    }
  }
  return true;
}

bool growWithHistory(const Plan& plan, Curve& curve) {
  const bench::EmulatedRig rig(plan.history_cameras, kWidthPx, kHeightPx);
  if (!rig.ready()) {
    std::fprintf(stderr, "growth: %s\n", rig.error().c_str());
    return false;
  }
  curve.cpu.resize(plan.sets.size());
  for (int round = 0; round < plan.rounds * 2; ++round) {
    for (std::size_t i = 0; i < plan.sets.size(); ++i) {
      const std::size_t at = round % 2 == 0 ? i : plan.sets.size() - 1 - i;
      bench::ReceptionSetup setup = rig.setup(plan.history_cameras, kRate_hz);
      setup.sets = plan.sets[at];
      if (!measure(setup, curve, at, plan.length)) return false;
    }
  }
  return true;
}

bool plot(const std::filesystem::path& folder, const Plan& plan, const std::vector<Curve>& cameras,
          const Curve& history) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!write(folder / "growth_cameras.dat", plan.cameras, cameras) ||
      !write(folder / "growth_history.dat", plan.sets, {history})) {
    std::fprintf(stderr, "growth: %s cannot be written\n", folder.c_str());
    return false;
  }
  const std::string command = "gnuplot -e \"folder='" + folder.string() + "'\" " GROWTH_PLOT;
  test::ChildProcess gnuplot({"/bin/sh", "-c", command}, folder / "gnuplot.log");
  if (gnuplot.wait(30s) != 0) {
    std::printf("    no plots (gnuplot-nox draws them): %s\n", gnuplot.output().c_str());
  } else {
    std::printf("    plots: %s/growth_cameras.png, growth_history.png\n", folder.c_str());
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  std::filesystem::path folder;
  if (arguments.size() == 3 && arguments[1] == "--plots") folder = arguments[2];
  if (folder.empty() && arguments.size() > 1) {
    std::fputs("usage: growth_bench [--quick] [--rows FILE] [--plots FOLDER]\n", stderr);
    return 2;
  }
  const Plan plan =
      options.quick ? Plan{{1, 2, 3}, {8, 16}, 1, 1, 200ms}
                    : Plan{{1, 5, 10, 15, 20, 25, 30, 35, 40}, {50, 150, 300, 600}, 8, 3, 1000ms};
  std::vector<Curve> cameras{{"kagami", bench::receiveAsAppliance},
                             {"minimal Aravis client", [](const auto& setup, auto& /*board*/) {
                                return bench::receiveByAravis(setup);
                              }}};
  Curve history{"kagami", bench::receiveAsAppliance};
  if (!growWithCameras(plan, cameras) || !growWithHistory(plan, history)) return 1;
  if (!folder.empty() && !plot(folder, plan, cameras, history)) return 1;

  const Line ours = fit(medians(plan.cameras, cameras[0]));
  const Line rival = fit(medians(plan.cameras, cameras[1]));
  const bool complete =
      std::ranges::none_of(cameras[0].cpu, [](const auto& v) { return v.empty(); });
  using Kind = bench::Bar::Kind;
  const std::string range = std::to_string(plan.cameras.front()) + " to " +
                            std::to_string(plan.cameras.back()) + " cameras";
  const std::vector<bench::Comparison> comparisons{
      {.what = range + ", linear fit",
       .unit = "R^2",
       .ours = {"kagami", {ours.r2}},
       .bar = bench::Bar{Kind::kOursAtLeast, 0.98},
       .not_judged = complete ? "" : "frames lost"},
      {.what = "one more camera",
       .unit = "CPU-ms/s",
       .ours = {"kagami", {ours.slope * 1e3}},
       .rival = {"minimal Aravis client", {rival.slope * 1e3}}},
      {.what = "history of " + std::to_string(plan.sets.back()) + " sets beside " +
               std::to_string(plan.sets.front()),
       .unit = "CPU-s/s",
       .ours = {std::to_string(plan.sets.back()) + " sets", history.cpu.back()},
       .rival = {std::to_string(plan.sets.front()) + " sets", history.cpu.front()},
       .bar = bench::Bar{Kind::kRatioAtMost, 1.1}}};
  return bench::report("growth", comparisons, options) ? 0 : 1;
}
