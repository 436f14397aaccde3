#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/panel/panel_controller.h"
#include "tests/property/any_value.h"
#include "tests/support/panel_gestures.h"

namespace {

using namespace std::chrono_literals;
using hal::Button;
using hal::ButtonEvent;
using property_test::anyIn;
using test::Expected;
using test::Gesture;

constexpr int kGestures = 100;  // of one case; rapidcheck tries 100 cases
constexpr std::size_t kButtons = hal::kButtons.size();

/// Buttons pressed in any order and together. No two instants are equal: every gesture has its own
/// nanosecond, so nothing depends on the order of simultaneous things.
std::vector<Gesture> anyGestures() {
  std::vector<Gesture> gestures;
  std::array<rt::Timestamp, kButtons> free_at{};
  rt::Timestamp now = rt::fromNs(1'000'000'000);
  for (int i = 0; i < kGestures; ++i) {
    now += anyIn(1, 400) * 1ms;
    const auto button = static_cast<std::size_t>(anyIn(0, static_cast<int>(kButtons)));
    if (now < free_at[button]) continue;  // it is down still
    const bool heard = anyIn(0, 10) > 0;
    const Gesture gesture{.button = static_cast<Button>(button),
                          .press = now + i * 1ns,
                          .release = now + anyIn(10, 2500) * 1ms + (500 + i) * 1ns,
                          .press_heard = anyIn(0, 20) > 0,
                          .release_heard = heard};
    gestures.push_back(gesture);
    // A release whose event was lost is found within a repetition's time.
    free_at[button] = gesture.release + (heard ? 5ms : 130ms);
  }
  return gestures;
}

/// What the panel delivers of them, with what bouncing contacts add: a press or release of a
/// button that already is as the event says.
std::vector<ButtonEvent> eventsOf(const std::vector<Gesture>& gestures) {
  std::vector<ButtonEvent> events;
  for (const Gesture& gesture : gestures) {
    if (gesture.press_heard) events.push_back({gesture.button, true, gesture.press});
    if (gesture.release_heard) events.push_back({gesture.button, false, gesture.release});
    if (gesture.press_heard && anyIn(0, 3) == 0)
      events.push_back({gesture.button, true, gesture.press + anyIn(1, 9) * 1ms});
    if (gesture.release_heard && anyIn(0, 3) == 0)
      events.push_back({gesture.button, false, gesture.release + anyIn(1, 4) * 1ms});
  }
  std::ranges::sort(events, {}, &ButtonEvent::at);
  return events;
}

RC_GTEST_PROP(PanelControllerProperty, ActsAsItsManualSaysUnderBounceChordsAndLostEdges, ()) {
  const std::vector<Gesture> gestures = anyGestures();
  rt::Timestamp now;
  appliance::PanelController controller([&](Button button) {
    return std::ranges::any_of(gestures, [&](const Gesture& gesture) {
      return gesture.button == button && gesture.press <= now && now < gesture.release;
    });
  });
  std::vector<Expected> given;
  const auto take = [&](const std::optional<appliance::PanelCommand>& command) {
    if (command) given.push_back({command->cause, command->command.kind});
  };
  const auto passTime = [&](rt::Timestamp until) {
    while (controller.nextTime() && *controller.nextTime() < until) {
      now = *controller.nextTime();
      take(controller.onTime(now));
    }
    now = until;
  };
  for (const ButtonEvent& event : eventsOf(gestures)) {
    passTime(event.at);
    take(controller.onEvent(event));
  }
  passTime(now + 10s);
  RC_ASSERT(!controller.nextTime());  // no button is stuck
  std::ranges::sort(given);
  RC_ASSERT(given == test::manualSays(gestures));
}

}  // namespace
