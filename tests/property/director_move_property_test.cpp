#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/director/move.h"
#include "tests/property/any_value.h"

namespace {

using appliance::Move;
using property_test::anyIn;

const rt::Timestamp kBegin = rt::fromNs(1'000'000'000);

Move anyMove() {
  return {.from_deg = anyIn(-3600, 3600) / 10.0,
          .to_deg = anyIn(-3600, 3600) / 10.0,
          .speed_deg_per_s = anyIn(1, 4000) / 10.0,
          .ease = anyIn(0, 51) / 100.0,
          .pause = rt::Nanoseconds(anyIn(0, 1'000'000'000)),
          .begin = kBegin};
}

RC_GTEST_PROP(MoveProperty, NeverTurnsNorGoesFasterThanItsSpeedAndEndsExactly, ()) {
  const Move move = anyMove();
  const rt::Nanoseconds whole = move.arrival() - move.begin;
  const double towards = move.to_deg < move.from_deg ? -1 : 1;
  double last_deg = move.from_deg;
  for (int i = 0; i <= 1000; ++i) {
    const double angle_deg = move.angle(kBegin + whole * i / 1000);
    const double way_deg = (angle_deg - last_deg) * towards;
    RC_ASSERT(way_deg >= -1e-9);
    const double most_deg = move.speed_deg_per_s * static_cast<double>(whole.count()) * 1e-12;
    RC_ASSERT(way_deg <= most_deg * 1.001 + 1e-6);
    last_deg = angle_deg;
  }
  RC_ASSERT(move.angle(move.arrival()) == move.to_deg);
  RC_ASSERT(move.angle(move.end()) == move.to_deg);
  RC_ASSERT(move.angle(kBegin) == (whole.count() == 0 ? move.to_deg : move.from_deg));
}

RC_GTEST_PROP(MoveProperty, InterruptedAtAnyInstantTheNextOneBeginsWhereItWas, ()) {
  const Move first = anyMove();
  const auto span_ns = (first.end() - first.begin).count();
  const rt::Timestamp when = kBegin + rt::Nanoseconds(span_ns / 1000 * anyIn(0, 1001));
  Move second = anyMove();
  second.begin = when;
  second.from_deg = first.angle(when);
  RC_ASSERT(second.angle(when) == second.from_deg || second.arrival() == second.begin);
  const double shortly_deg = second.angle(when + std::chrono::microseconds(1));
  RC_ASSERT(std::abs(shortly_deg - second.from_deg) <= 1e-3 || second.arrival() == second.begin);
}

}  // namespace
