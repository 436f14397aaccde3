#include <chrono>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/capture/genlock.h"

namespace {

using appliance::Genlock;
using appliance::GenlockState;
using namespace std::chrono_literals;
using rt::Nanoseconds;
using rt::Timestamp;

constexpr Timestamp kStart = rt::fromNs(1'000'000'000'000);

Nanoseconds between(Nanoseconds least, Nanoseconds most) {
  return Nanoseconds(*rc::gen::inRange<std::int64_t>(least.count(), most.count() + 1));
}

/// A screen of 24 to 240 Hz, its vblanks anywhere.
hal::DisplayTiming anyScreen() {
  return {.vblank = *rc::gen::inRange<std::uint64_t>(0, 1'000'000),
          .at = kStart + between(-20ms, 20ms),
          .period_ns = 1e9 / *rc::gen::inRange(24, 241),
          .stamp_jitter_ns = 0,
          .draw = between(0ms, 20ms),
          .commit_margin = between(0us, 1000us)};
}

RC_GTEST_PROP(GenlockProperty, LocksAtEveryWholeRatioFromEveryPhaseWithinFiftyVblanks, ()) {
  const hal::DisplayTiming screen = anyScreen();
  const int vblanks = *rc::gen::inRange(1, 7);
  const double mistuned = *rc::gen::inRange(-4900, 4901) * 1e-6;
  const Nanoseconds period(std::llround(vblanks * screen.period_ns * (1 + mistuned)));
  const Nanoseconds margin = between(0us, 3000us);
  const Nanoseconds ready = between(1ms, 60ms);
  Genlock genlock({.enabled = true, .period = period, .margin = margin});
  genlock.take({.timing = screen, .ready_delay = ready});

  const double most_ns =
      (Genlock::kMostSlew + Genlock::kMostMistuned) * static_cast<double>(period.count()) + 2;
  Timestamp deadline = kStart + between(0ns, period);
  int steps = 0;
  // Half a vblank at 1 % of a period each, what rounding leaves, and four in a row.
  const int most_steps = 50 / vblanks + 8;
  while (genlock.status().state != GenlockState::kLocked) {
    RC_ASSERT(++steps <= most_steps);
    deadline += period;
    const Nanoseconds moved = genlock.step(deadline);
    RC_ASSERT(std::abs(static_cast<double>(moved.count())) <= most_ns);
    deadline += moved;
  }
  RC_ASSERT(genlock.status().vblanks_per_trigger == static_cast<std::uint32_t>(vblanks));
  for (int i = 0; i < 100; ++i) {
    deadline += period;
    deadline += genlock.step(deadline);
    const std::uint64_t vblank = screen.firstVblankAfter(
        deadline + genlock.status().lead - Nanoseconds(std::llround(screen.period_ns / 2)));
    const Nanoseconds spare = screen.latestStart(vblank) - (deadline + ready);
    RC_ASSERT(std::chrono::abs(spare - margin) <= 2ns);
    RC_ASSERT(genlock.status().state == GenlockState::kLocked);
  }
}

RC_GTEST_PROP(GenlockProperty, NeverMovesADeadlineFartherThanItMayWhateverItIsTold, ()) {
  const Nanoseconds period = between(1ms, 200ms);
  Genlock genlock({.enabled = true, .period = period, .margin = between(0us, 3000us)});
  const double most_ns =
      (Genlock::kMostSlew + Genlock::kMostMistuned) * static_cast<double>(period.count()) + 2;
  Timestamp deadline = kStart;
  std::uint64_t unlocks = 0;
  for (int i = 0; i < 60; ++i) {
    deadline += period;
    hal::DisplayTiming screen = anyScreen();
    screen.at = deadline - between(0ms, 70s);
    if (*rc::gen::inRange(0, 2) == 0) {
      screen.period_ns = static_cast<double>(period.count()) / *rc::gen::inRange(1, 4);
    }
    const bool known = *rc::gen::inRange(0, 3) > 0;
    genlock.take({.timing = known ? std::optional(screen) : std::nullopt,
                  .ready_delay = between(0ms, 60ms)});
    const Nanoseconds moved = genlock.step(deadline);
    RC_ASSERT(std::abs(static_cast<double>(moved.count())) <= most_ns);
    if (genlock.status().state == GenlockState::kFreeRunning) RC_ASSERT(moved == 0ns);
    RC_ASSERT(genlock.status().unlocks >= unlocks);
    unlocks = genlock.status().unlocks;
    deadline += moved;
  }
}

}  // namespace
