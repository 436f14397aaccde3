#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/director/playhead.h"
#include "tests/property/any_value.h"

namespace {

using appliance::Playhead;
using appliance::Rate;
using property_test::anyIn;

Rate anySlowOrFullRate() {
  return static_cast<Rate>(anyIn(1, 5));
}

/// For how many vblanks each trigger is shown, the first and the last left out.
std::vector<int> durations(Playhead& playhead, rt::Nanoseconds refresh, rt::Nanoseconds period,
                           int vblanks) {
  rt::Timestamp vblank = rt::fromNs(1'000'000'000);
  std::vector<int> shown;
  std::uint64_t last = 0;
  for (int i = 0; i < vblanks; ++i) {
    vblank += refresh;
    const rt::Nanoseconds off = refresh * anyIn(-20, 21) / 100;  // what a prediction is off by
    playhead.advance({.at = vblank + off, .refresh = refresh}, period);
    if (i == 0) playhead.seek(1000);
    RC_ASSERT(playhead.trigger() >= last);
    if (playhead.trigger() != last) shown.push_back(0);
    last = playhead.trigger();
    ++shown.back();
  }
  if (!shown.empty()) shown.pop_back();
  if (!shown.empty()) shown.erase(shown.begin());
  return shown;
}

RC_GTEST_PROP(PlayheadProperty, WholeVblanksPerTriggerAreKeptExactly, ()) {
  const Rate rate = anySlowOrFullRate();
  const int each = anyIn(1, 5);  // vblanks per trigger at full speed
  const rt::Nanoseconds refresh(anyIn(4'000'000, 34'000'000));
  // The screen's true period is up to 0.4 % off from the nominal one.
  const rt::Nanoseconds period(refresh.count() * each * (1000 + anyIn(-4, 5)) / 1000);
  Playhead playhead;
  playhead.setRate(rate);
  const auto wanted = static_cast<int>(std::lround(each / factorOf(rate)));
  for (const int shown : durations(playhead, refresh, period, 40 * wanted))
    RC_ASSERT(shown == wanted);
}

RC_GTEST_PROP(PlayheadProperty, OtherwiseTwoTriggersDifferByOneVblankAtMost, ()) {
  const rt::Nanoseconds refresh(anyIn(4'000'000, 34'000'000));
  const rt::Nanoseconds period = refresh + rt::Nanoseconds(anyIn(0, 100'000'000));
  Playhead playhead;
  playhead.setRate(anySlowOrFullRate());
  const auto shown = durations(playhead, refresh, period, 400);
  if (shown.empty()) return;
  RC_ASSERT(std::ranges::max(shown) - std::ranges::min(shown) <= 1);
}

RC_GTEST_PROP(PlayheadProperty, NeverGoesBackWhateverTheRateAndTheScreenDo, ()) {
  const rt::Nanoseconds period(anyIn(4'000'000, 100'000'000));
  Playhead playhead;
  playhead.seek(1000);
  rt::Timestamp at = rt::fromNs(1'000'000'000);
  std::uint64_t last = 0;
  double last_fraction = 0;
  for (int i = 0; i < 200; ++i) {
    playhead.setRate(static_cast<Rate>(anyIn(0, 5)));
    const rt::Nanoseconds refresh(anyIn(0, 3) == 0 ? 0 : anyIn(4'000'000, 34'000'000));
    at += rt::Nanoseconds(anyIn(-10'000'000, 60'000'000));
    playhead.advance({.at = at, .refresh = refresh}, period);
    RC_ASSERT(playhead.trigger() > last ||
              (playhead.trigger() == last && playhead.fraction() >= last_fraction));
    last = playhead.trigger();
    last_fraction = playhead.fraction();
  }
}

RC_GTEST_PROP(PlayheadProperty, KeepsNearAMovingGoalEvenlyAndWithoutGoingBack, ()) {
  const int each = anyIn(1, 4);
  const rt::Nanoseconds refresh(anyIn(6'000'000, 34'000'000));
  const rt::Nanoseconds period = refresh * each;
  Playhead playhead;
  rt::Timestamp at = rt::fromNs(1'000'000'000);
  playhead.advance({.at = at, .refresh = refresh}, period);
  playhead.seek(1000);
  const int phase = anyIn(0, each);
  int same = 1;
  std::uint64_t last = 1000;
  for (int vblank = 1; vblank < 200; ++vblank) {
    at += refresh;
    playhead.advance({.at = at, .refresh = refresh}, period);
    // The newest frame comes at some phase of the trigger, now and then a vblank late.
    const int late = each > 1 && anyIn(0, 5) == 0 ? 1 : 0;
    playhead.keepNear(1000 + static_cast<std::uint64_t>((vblank + phase - late) / each));
    if (playhead.trigger() == last) {
      ++same;
      continue;
    }
    RC_ASSERT(playhead.trigger() == last + 1);
    RC_ASSERT(same == each);
    last = playhead.trigger();
    same = 1;
  }
}

}  // namespace
