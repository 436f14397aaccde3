#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "appliance/director/command.h"
#include "hal/button_panel.h"
#include "rt/clock.h"

namespace test {

/// A button held from one instant to another. Whether the panel heard of both ends is the world's
/// business.
struct Gesture {
  hal::Button button = hal::Button::kLive;
  rt::Timestamp press;
  rt::Timestamp release;
  bool press_heard = true;
  bool release_heard = true;
};

struct Expected {
  rt::Timestamp cause;
  appliance::Command::Kind kind;
  friend auto operator<=>(const Expected&, const Expected&) = default;
};

/// What holding each button comes to: said once more, from the panel's manual and not from its
/// code. Pressed buttons act; of those held only the last one pressed goes on.
inline std::vector<Expected> manualSays(const std::vector<Gesture>& gestures) {
  using namespace std::chrono_literals;
  using enum appliance::Command::Kind;
  constexpr std::array kOnPress = {kGoLive,      kFreezeToggle, kDelayLess, kDelayMore, kStepBack,
                                   kStepForward, kViewLeft,     kViewRight, kSweep,     kSlower};
  std::vector<Expected> expected;
  for (const Gesture& gesture : gestures) {
    if (!gesture.press_heard) continue;
    const auto kind = kOnPress.at(static_cast<std::size_t>(gesture.button));
    expected.push_back({gesture.press, kind});
    rt::Timestamp end = gesture.release;
    for (const Gesture& other : gestures) {
      if (other.press_heard && other.press > gesture.press) end = std::min(end, other.press);
    }
    switch (kind) {
      case kGoLive:
        if (gesture.press + 1500ms < end) expected.push_back({gesture.press + 1500ms, kHome});
        break;
      case kFreezeToggle:
      case kSweep:
      case kSlower:
        break;
      default:
        for (auto due = gesture.press + 400ms; due < end; due += 125ms)
          expected.push_back({due, kind});
    }
  }
  std::ranges::sort(expected);
  return expected;
}

}  // namespace test
