// Who has which slot of a camera's history while the camera dies and comes back.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/capture/camera_frames.h"

namespace {

using appliance::CameraFrames;
using appliance::PinnedFrame;

constexpr std::uint32_t kReserve = 3;

/// A camera's side of the slots: what it was given at its start and what it got back since.
struct Stream {
  std::vector<std::uint32_t> in_hand;

  explicit Stream(const CameraFrames& frames)
      : in_hand(frames.fillingSlots().begin(), frames.fillingSlots().end()) {}
};

RC_GTEST_PROP(SlotOwnership, NoSlotLeaksNorIsFilledTwiceHoweverOftenTheStreamEnds, ()) {
  const auto sets = *rc::gen::inRange<std::uint32_t>(2, 9);
  const auto in_flight = *rc::gen::inRange<std::uint32_t>(1, 6);
  std::vector<std::byte> memory(std::size_t{sets} + in_flight + 1 + kReserve);
  std::vector<std::span<std::byte>> slots;
  for (std::byte& slot : memory) slots.emplace_back(&slot, 1);
  CameraFrames frames(slots, {}, sets, in_flight);

  Stream stream(frames);
  rt::PinBudget budget(kReserve);
  std::vector<PinnedFrame> pins;
  std::uint64_t trigger = 0;
  const auto steps = *rc::gen::inRange(0, 150);
  for (int step = 0; step < steps; ++step) {
    switch (*rc::gen::inRange(0, 5)) {
      case 0:
      case 1: {  // one of the filling frames is complete; triggers between may deliver none
        trigger += *rc::gen::inRange<std::uint64_t>(1, 4);
        const auto at = *rc::gen::inRange<std::size_t>(0, stream.in_hand.size());
        stream.in_hand[at] = frames.store(stream.in_hand[at], {.trigger = trigger});
        break;
      }
      case 3: {
        if (*rc::gen::inRange(0, 2) == 0) {
          if (!pins.empty()) pins.pop_back();
        } else if (auto pin = frames.tryPin(trigger, budget)) {
          pins.push_back(std::move(*pin));
        }
        break;
      }
      case 4:  // the stream ends amid any frames, and another begins
        stream = Stream(frames);
        break;
      default:  // a frame that is not stored is filled over: nothing moves
        break;
    }

    const std::set<std::uint32_t> filling(stream.in_hand.begin(), stream.in_hand.end());
    RC_ASSERT(filling.size() == in_flight);
    RC_ASSERT(std::ranges::is_permutation(stream.in_hand, frames.fillingSlots()));
    for (std::uint64_t seen = frames.oldest(); seen != 0 && seen <= trigger; ++seen) {
      const auto pinned = frames.tryPin(seen, budget);
      if (pinned) RC_ASSERT(!filling.contains(pinned->pin.slot()));
    }
    for (const PinnedFrame& pin : pins) RC_ASSERT(!filling.contains(pin.pin.slot()));
  }
  // Nothing leaked: every slot can still go round.
  pins.clear();
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < 4 * slots.size(); ++i) {
    seen.insert(stream.in_hand.front());
    const std::uint32_t next = frames.store(stream.in_hand.front(), {.trigger = ++trigger});
    stream.in_hand.erase(stream.in_hand.begin());
    stream.in_hand.push_back(next);
  }
  RC_ASSERT(seen.size() >= std::size_t{sets} + in_flight);
}

}  // namespace
