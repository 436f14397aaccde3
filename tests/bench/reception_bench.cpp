#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/bench/reception/round.h"
#include "tests/bench/support/comparison.h"

// CPU seconds per gigabyte of received frames, in turns: the product's reception, a minimal Aravis
// client, and recvmmsg(2) with a copy.

namespace {

using namespace std::chrono_literals;

struct Load {
  std::uint32_t cameras;
  double rate_hz;
};

struct Entry {
  std::string name;
  bench::Contestant contestant;
  std::vector<double> cpu_s_per_gb = {};
  std::uint64_t lost = 0;
  std::uint64_t expected = 0;
};

std::array<Entry, 3> entries() {
  return {Entry{"kagami", bench::receiveAsAppliance},
          Entry{"minimal Aravis client",
                [](const auto& setup, auto& /*board*/) { return bench::receiveByAravis(setup); }},
          Entry{"recvmmsg and copy", [](const auto& setup, auto& /*board*/) {
                  return bench::receiveByRecvmmsg(setup);
                }}};
}

bool runRounds(const bench::EmulatedRig& rig, const Load& load, int rounds,
               std::chrono::milliseconds length, std::array<Entry, 3>& all) {
  const bench::ReceptionSetup setup = rig.setup(load.cameras, load.rate_hz);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      // Each contestant comes first, second and last as often as the others.
      Entry& entry = all[(i + static_cast<std::size_t>(round)) % all.size()];
      const auto result = bench::runRound(setup, entry.contestant, length);
      if (!result) {
        std::fprintf(stderr, "reception: %s: %s\n", entry.name.c_str(), result.error().c_str());
        return false;
      }
      entry.expected += result->expected;
      entry.lost += result->expected - std::min(result->frames, result->expected);
      if (result->frames < result->expected && !result->stalls.empty()) {
        std::printf("    %s lost frames, but %s\n", entry.name.c_str(), result->stalls.c_str());
      }
      if (result->bytes == 0 || !result->valid()) continue;
      entry.cpu_s_per_gb.push_back(result->cpu_s * 1e9 / static_cast<double>(result->bytes));
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  if (arguments.size() > 1) {
    std::fputs("usage: reception_bench [--quick] [--rows FILE]\n", stderr);
    return 2;
  }
  const std::vector<Load> loads =
      options.quick ? std::vector<Load>{{2, 20}} : std::vector<Load>{{8, 40}, {20, 40}};
  std::vector<bench::Comparison> comparisons;
  for (const Load& load : loads) {
    const bench::EmulatedRig rig(load.cameras, 1280, 1024);
    if (!rig.ready()) {
      std::fprintf(stderr, "reception: %s\n", rig.error().c_str());
      return 1;
    }
    auto all = entries();
    if (!runRounds(rig, load, options.quick ? 1 : 9, options.quick ? 300ms : 1500ms, all)) return 1;
    for (const Entry& entry : all) {
      std::printf("    %u cameras, %.0f Hz, %-22s %llu of %llu frames lost\n", load.cameras,
                  load.rate_hz, entry.name.c_str(), static_cast<unsigned long long>(entry.lost),
                  static_cast<unsigned long long>(entry.expected));
    }
    const std::string what = std::to_string(load.cameras) + " cameras";
    const bench::Samples ours{all[0].name, all[0].cpu_s_per_gb};
    const std::string lossy =
        all[0].cpu_s_per_gb.empty() || all[1].cpu_s_per_gb.empty() ? "frames lost" : "";
    comparisons.push_back({.what = what + ", beside Aravis alone",
                           .unit = "CPU-s/GB",
                           .ours = ours,
                           .rival = {all[1].name, all[1].cpu_s_per_gb},
                           .bar = bench::Bar{bench::Bar::Kind::kRatioAtMost, 1.15},
                           .not_judged = lossy});
    comparisons.push_back({.what = what + ", beside recvmmsg",
                           .unit = "CPU-s/GB",
                           .ours = ours,
                           .rival = {all[2].name, all[2].cpu_s_per_gb}});
  }
  return bench::report("reception", comparisons, options) ? 0 : 1;
}
