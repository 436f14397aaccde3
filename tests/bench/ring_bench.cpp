#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <boost/lockfree/spsc_queue.hpp>

#include "rt/spsc_ring.h"
#include "tests/bench/support/cpus.h"
#include "tests/bench/support/google.h"

// One value through a ring of 512: on one thread, and from one core to another.

namespace {

constexpr std::uint32_t kCapacity = 512;  // of a trace ring

using Index = std::uint32_t;
struct Record {  // a cache line, as most of what the product sends
  std::array<std::uint64_t, 8> words{};
};

/// The value is used: a small one from a register, a large one from memory.
template <typename T>
void use(const T& value) {
  if constexpr (sizeof(T) <= sizeof(void*)) {
    asm volatile("" : : "r"(value) : "memory");
  } else {
    asm volatile("" : : "m"(value) : "memory");
  }
}

// Each rival as its users write it.
template <typename T>
struct OurRing {
  bool push(const T& value) { return ring.tryPush(value); }
  bool pop() {
    const std::optional<T> value = ring.tryPop();
    if (!value) return false;
    use(*value);
    return true;
  }
  rt::SpscRing<T, kCapacity> ring;
};

template <typename T>
struct BoostRing {
  bool push(const T& value) { return ring.push(value); }
  bool pop() {
    T value;
    if (!ring.pop(value)) return false;
    use(value);
    return true;
  }
  boost::lockfree::spsc_queue<T, boost::lockfree::capacity<kCapacity>> ring;
};

/// Bursts, as the trace's rings are filled and emptied; kBurst 1: every value immediately.
template <typename Ring, typename T, int kBurst>
void oneThread(benchmark::State& state) {
  const auto ring = std::make_unique<Ring>();
  const T value{};
  while (state.KeepRunningBatch(kBurst)) {
    for (int i = 0; i < kBurst; ++i) benchmark::DoNotOptimize(ring->push(value));
    for (int i = 0; i < kBurst; ++i) benchmark::DoNotOptimize(ring->pop());
  }
}

/// As every loop that spins: the peer's cache line is left alone for a moment.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

template <typename Ring, typename T>
void twoCores(benchmark::State& state) {
  const std::vector<int> cpus = bench::allowedCpus();
  if (cpus.size() < 2) {
    state.SkipWithError("needs two CPUs");
    return;
  }
  const auto ring = std::make_unique<Ring>();
  std::atomic<bool> ready{false};
  std::jthread consumer([&](const std::stop_token& stop) {
    bench::pinCurrentThread({cpus[1]});
    ready.store(true, std::memory_order_release);
    while (!stop.stop_requested()) {
      for (std::uint32_t i = 0; i < kCapacity; ++i) {
        if (!ring->pop()) pause();
      }
    }
  });
  bench::pinCurrentThread({cpus[0]});
  while (!ready.load(std::memory_order_acquire)) std::this_thread::yield();
  const T value{};
  for (auto _ : state) {
    while (!ring->push(value)) pause();
  }
  bench::pinCurrentThread(cpus);
}

template <typename T>
void add(const std::string& type) {
  const auto add_one = [&](const std::string& name, auto* function) {
    benchmark::RegisterBenchmark((name + type).c_str(), function)->UseRealTime();
  };
  add_one("ours/burst/", oneThread<OurRing<T>, T, 64>);
  add_one("boost/burst/", oneThread<BoostRing<T>, T, 64>);
  add_one("ours/one/", oneThread<OurRing<T>, T, 1>);
  add_one("boost/one/", oneThread<BoostRing<T>, T, 1>);
  add_one("ours/cores/", twoCores<OurRing<T>, T>);
  add_one("boost/cores/", twoCores<BoostRing<T>, T>);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  add<Index>("4 bytes");
  add<Record>("64 bytes");
  bench::Repetitions results;
  if (!bench::runGoogleBenchmarks(arguments, options, results)) return 2;
  const bench::Bar bar{bench::Bar::Kind::kRatioAtLeast, 1.0};
  std::vector<bench::Comparison> comparisons;
  for (const std::string type : {"4 bytes", "64 bytes"}) {
    const auto add_row = [&](const std::string& what, const std::string& key,
                             const std::optional<bench::Bar>& its_bar) {
      comparisons.push_back({.what = type + what,
                             .unit = "ns",
                             .ours = results.samples("ours/" + key + type, "rt::SpscRing"),
                             .rival = results.samples("boost/" + key + type, "boost spsc_queue"),
                             .as_speed = true,
                             .bar = its_bar});
    };
    add_row(", core to core", "cores/", bar);
    add_row(", bursts on one thread", "burst/", bar);
    // Neither side ever waits for the other here: no throughput of a ring between threads.
    add_row(", in turns on one thread", "one/", std::nullopt);
  }
  return bench::report("ring", comparisons, options) ? 0 : 1;
}
