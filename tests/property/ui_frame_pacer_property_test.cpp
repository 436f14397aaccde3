#include <chrono>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/simulated_screen.h"
#include "ui-kms/frame_pacer.h"

namespace {

using namespace std::chrono_literals;

constexpr rt::Timestamp kStart = rt::fromNs(50'000'000'000'000);

RC_GTEST_PROP(FramePacerProperty, KnowsTheVblanksOfEveryScreenWhateverEventsAreLost, ()) {
  const double hz = *rc::gen::inRange(24, 241);
  SimulatedScreen screen({.nominal_hz = hz,
                          .off_ppm = static_cast<double>(*rc::gen::inRange(-300, 301)),
                          .wander_ppm = 2},
                         *rc::gen::inRange(0, 50'001), kStart,
                         *rc::gen::arbitrary<std::uint32_t>());
  ui::FramePacer pacer(hz);
  std::uint64_t vblank = *rc::gen::inRange<std::uint64_t>(0, 1000);
  const int events = *rc::gen::inRange(200, 600);
  for (int i = 0; i < events; ++i) {
    vblank += *rc::gen::weightedElement<std::uint64_t>({{20, 1}, {10, 2}, {4, 3}, {1, 20}});
    pacer.onVblank(vblank, screen.flip(1, vblank).page_flip);
  }
  RC_ASSERT(pacer.timing().has_value());
  const rt::Nanoseconds off = pacer.timing()->vblankAt(vblank + 2) - screen.truly(vblank + 2);
  RC_ASSERT(std::chrono::abs(off) <= 70us);
}

RC_GTEST_PROP(FramePacerProperty, ComesBackToATrueScreenAfterAnyNonsense, ()) {
  ui::FramePacer pacer(60);
  for (int i = 0; i < 50; ++i) {
    pacer.onVblank(*rc::gen::inRange<std::uint64_t>(0, 5000),
                   rt::fromNs(*rc::gen::inRange<std::int64_t>(0, 100'000'000'000'000)));
    if (const auto timing = pacer.timing())
      RC_ASSERT(std::abs(timing->period_ns * 60e-9 - 1) <= 0.05);
  }
  SimulatedScreen screen({.nominal_hz = 60}, 10e3, kStart, 1);
  for (std::uint64_t vblank = 6000; vblank < 6300; ++vblank)
    pacer.onVblank(vblank, screen.flip(1, vblank).page_flip);
  RC_ASSERT(pacer.timing().has_value());
  const rt::Nanoseconds off = pacer.timing()->vblankAt(6400) - screen.truly(6400);
  RC_ASSERT(std::chrono::abs(off) <= 50us);
}

RC_GTEST_PROP(FramePacerProperty, NeverTellsAPeriodThatNoScreenHas, ()) {
  ui::FramePacer pacer(60);
  rt::Timestamp stamp = kStart;
  for (std::uint64_t vblank = 0; vblank < 300; ++vblank) {
    stamp += std::chrono::microseconds(*rc::gen::inRange(10'000, 24'000));
    pacer.onVblank(vblank, stamp);
    if (const auto timing = pacer.timing())
      RC_ASSERT(std::abs(timing->period_ns * 60e-9 - 1) <= 0.05);
  }
}

}  // namespace
