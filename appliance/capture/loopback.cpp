#include "appliance/capture/loopback.h"

#include <chrono>
#include <thread>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;

/// An edge that takes longer than this, opto-isolators included, does not come.
constexpr rt::Nanoseconds kLongestEdge = 20ms;

/// Opening the line may just have changed its level: wait until the loop-back has followed. A
/// loop-back that never rests (an open input) is checked after kLongestUnrest.
constexpr rt::Nanoseconds kQuiet = 5ms;
constexpr rt::Nanoseconds kLongestUnrest = 100ms;

constexpr rt::Nanoseconds kStopPoll = 100ms;

/// The kernel may show an edge before the trigger loop has posted it.
constexpr int kLooksForTrigger = 5;
constexpr rt::Nanoseconds kBetweenLooks = 1ms;

}  // namespace

std::expected<void, std::string> judgeLoopback(const LoopbackReading& reading) {
  const auto wrong = [](const Phrase& why) { return std::unexpected(textOf(why)); };
  if (reading.before && !reading.during && reading.after)
    return wrong(phrase<Word::kLoopbackPolarity>());
  if (reading.before == reading.during)
    return wrong(reading.before ? phrase<Word::kLoopbackStaysActive>()
                                : phrase<Word::kLoopbackStaysInactive>());
  if (reading.after != reading.before) return wrong(phrase<Word::kLoopbackOnce>());
  if (!reading.edge) return wrong(phrase<Word::kLoopbackNoStamps>());
  return {};
}

std::expected<void, std::string> checkLoopback(hal::TriggerLine& line, hal::EdgeInput& input) {
  const auto unreadable = [] { return std::unexpected(textOf(phrase<Word::kLoopbackGone>())); };
  const rt::Timestamp patience = rt::now() + kLongestUnrest;
  while (input.waitEdge(kQuiet) && rt::now() < patience) {
  }
  const auto before = input.isActive();
  if (!before || !line.setActive(true)) return unreadable();
  const bool edge = input.waitEdge(kLongestEdge).has_value();
  const auto during = input.isActive();
  if (!line.setActive(false)) return unreadable();
  (void)input.waitEdge(kLongestEdge);
  const auto after = input.isActive();
  if (!during || !after) return unreadable();
  return judgeLoopback({.before = *before, .during = *during, .after = *after, .edge = edge});
}

void LoopbackLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto edge = input_.waitEdge(kStopPoll);
    if (!edge || !edge->active) continue;
    trace_.record(LoopbackRecord{.trigger = triggerOf(edge->at), .edge = edge->at});
  }
}

std::uint64_t LoopbackLoop::triggerOf(rt::Timestamp edge) const {
  for (int look = 0; look < kLooksForTrigger; ++look) {
    if (const auto trigger = association_.triggerOf(edge, edges_)) return *trigger;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return 0;
}

}  // namespace appliance
