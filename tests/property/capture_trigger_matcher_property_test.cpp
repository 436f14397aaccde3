// Random faults against a model that knows which trigger each frame was taken at.
#include <cstdint>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/capture/trigger_matcher.h"

namespace {

using namespace std::chrono_literals;
using appliance::Association;
using appliance::EdgeBoard;
using appliance::TriggerMatcher;

constexpr rt::Nanoseconds kPeriod = 24ms;
constexpr rt::Nanoseconds kDelay = 1ms;
// Clocks are set by multiples of 4 ms, frames sent unasked 2 ms beside those: faults that cancel
// each other to within the tolerance are no faults to anybody who looks from outside.
constexpr rt::Nanoseconds kClockStep = 4ms;

enum class Event : std::uint8_t {
  kFollowed,
  kIgnored,      // the camera does not see the trigger
  kLost,         // its frame vanishes on the wire, with its id
  kHeldBack,     // its frame comes one period late
  kExtraFrame,   // one more frame follows that nothing asked for
  kSlowMachine,  // frames are not looked at for two periods
  kRebooted,     // clock and ids start again
  kClockSet,
  kIdJumped,
};

struct Step {
  Event event = Event::kFollowed;
  int amount = 0;
};

std::ostream& operator<<(std::ostream& out, const Step& step) {
  return out << static_cast<int>(step.event) << '(' << step.amount << ')';
}

rc::Gen<std::vector<Step>> anyFaults() {
  const auto event = rc::gen::weightedElement<Event>({{60, Event::kFollowed},
                                                      {4, Event::kIgnored},
                                                      {4, Event::kLost},
                                                      {4, Event::kHeldBack},
                                                      {4, Event::kExtraFrame},
                                                      {4, Event::kSlowMachine},
                                                      {1, Event::kRebooted},
                                                      {1, Event::kClockSet},
                                                      {1, Event::kIdJumped}});
  const auto step = rc::gen::apply([](Event e, int amount) { return Step{e, amount}; }, event,
                                   rc::gen::inRange(-5, 6));
  return rc::gen::resize(400, rc::gen::container<std::vector<Step>>(step));
}

/// One camera and the machine that looks at its frames, both with the given faults.
class Model {
 public:
  /// @p clock_step: what a clock is set by, times one to five.
  Model(bool has_clock, int drift_ppm, rt::Nanoseconds clock_step = kClockStep)
      : has_clock_(has_clock), drift_ppm_(drift_ppm), clock_step_(clock_step) {}

  void run(const std::vector<Step>& steps) {
    for (const Step& step : steps) take(step);
  }

  std::uint64_t wrong = 0;            // frames under another trigger than theirs
  std::uint64_t frames = 0;           // that were taken at a trigger and arrived
  std::uint64_t named = 0;            // of those
  std::uint64_t longest_unnamed = 0;  // in a row

 private:
  static rt::Timestamp edge(std::uint64_t trigger) {
    return rt::fromNs(5'000'000'000'000) + static_cast<std::int64_t>(trigger) * kPeriod;
  }
  rt::Nanoseconds clockAt(rt::Timestamp at) const {
    const std::int64_t ns = (at - clock_base_).count();
    return rt::Nanoseconds{ns + ns / 1'000'000 * drift_ppm_} + clock_set_;
  }

  void take(const Step& step) {
    ++trigger_;
    edges_->post(trigger_, edge(trigger_));
    const rt::Timestamp due = edge(trigger_) + kDelay;
    switch (step.event) {
      case Event::kFollowed:
        look(trigger_, edge(trigger_), due + 100us);
        break;
      case Event::kIgnored:
        break;
      case Event::kLost:
        ++frame_id_;
        break;
      case Event::kHeldBack:
        // Looked at after the next edge: the frame of that one comes behind it, in order.
        edges_->post(trigger_ + 1, edge(trigger_ + 1));
        look(trigger_, edge(trigger_), due + kPeriod);
        ++trigger_;
        look(trigger_, edge(trigger_), due + kPeriod + 10ms);
        break;
      case Event::kExtraFrame: {
        look(trigger_, edge(trigger_), due + 100us);
        const rt::Timestamp taken = edge(trigger_) + 2ms + 4ms * ((step.amount + 5) % 6);
        look(0, taken, taken + kDelay + 100us);
        break;
      }
      case Event::kSlowMachine:
        for (int more = 0; more < 2; ++more) {
          ++trigger_;
          edges_->post(trigger_, edge(trigger_));
        }
        for (std::uint64_t t = trigger_ - 2; t <= trigger_; ++t) {
          look(t, edge(t), edge(trigger_) + kDelay + 100us);
        }
        break;
      case Event::kRebooted:
        clock_base_ = edge(trigger_);
        clock_set_ = 1ms;
        frame_id_ = 0;
        matcher_.restart();  // it forgot its receiver: its stream was started again
        break;
      case Event::kClockSet:
        // Once in a run: two that add up to a period cannot be seen from outside.
        if (!std::exchange(clock_was_set_, true)) clock_set_ += step.amount * clock_step_;
        look(trigger_, edge(trigger_), due + 100us);
        break;
      case Event::kIdJumped:
        frame_id_ += 1000;
        look(trigger_, edge(trigger_), due + 100us);
        break;
    }
  }

  /// @p truth: the trigger whose edge started the exposure; 0: none.
  void look(std::uint64_t truth, rt::Timestamp taken, rt::Timestamp at) {
    const auto name = matcher_.match(
        {.arrival = at, .camera_clock = has_clock_ ? clockAt(taken) : 0ns, .frame_id = ++frame_id_},
        *edges_);
    if (name.trigger != 0 && name.trigger != truth) ++wrong;
    if (truth == 0) return;
    ++frames;
    if (name.trigger == truth) ++named;
    unnamed_ = name.trigger == truth ? 0 : unnamed_ + 1;
    longest_unnamed = std::max(longest_unnamed, unnamed_);
  }

  bool has_clock_;
  int drift_ppm_;
  rt::Nanoseconds clock_step_;
  std::unique_ptr<EdgeBoard> edges_ = std::make_unique<EdgeBoard>();
  TriggerMatcher matcher_{Association{kPeriod, kDelay}};
  std::uint64_t trigger_ = 0;
  std::uint64_t frame_id_ = 500;
  std::uint64_t unnamed_ = 0;
  rt::Timestamp clock_base_ = rt::fromNs(3'000'000'000'000);
  rt::Nanoseconds clock_set_{0};
  bool clock_was_set_ = false;
};

RC_GTEST_PROP(TriggerMatcher, NeverNamesAFrameWrongly, ()) {
  Model model(true, *rc::gen::inRange(-100, 101));
  model.run(*anyFaults());
  RC_ASSERT(model.wrong == 0U);
}

RC_GTEST_PROP(TriggerMatcher, NeverNamesAFrameWronglyWhereTheCameraHasNoClock, ()) {
  // Ids and arrivals alone cannot distinguish an extra frame from a trigger's own, nor a jump of
  // the ids from lost frames: such a camera is believed what it counts.
  Model model(false, 0);
  auto steps = *anyFaults();
  std::erase_if(steps, [](const Step& step) {
    return step.event == Event::kExtraFrame || step.event == Event::kSlowMachine;
  });
  model.run(steps);
  RC_ASSERT(model.wrong == 0U);
}

RC_GTEST_PROP(TriggerMatcher, NamesEveryFrameThatCameLateOrAfterIgnoredTriggers, ()) {
  Model model(true, *rc::gen::inRange(-100, 101));
  auto steps = *anyFaults();
  std::erase_if(steps, [](const Step& step) {
    return step.event == Event::kExtraFrame || step.event > Event::kSlowMachine;
  });
  steps.insert(steps.begin(), Step{});
  model.run(steps);
  RC_ASSERT(model.wrong == 0U);
  RC_ASSERT(model.named == model.frames);
}

RC_GTEST_PROP(TriggerMatcher, IsRightAgainWithTheThirdFrameAfterAnythingSudden, ()) {
  // A clock set by whole periods names other triggers as neatly as before: the worst case.
  const auto clock_step = *rc::gen::element(rt::Nanoseconds(kClockStep), rt::Nanoseconds(kPeriod));
  Model model(true, *rc::gen::inRange(-100, 101), clock_step);
  const auto sudden = *rc::gen::element(Event::kRebooted, Event::kClockSet, Event::kIdJumped);
  const int amount = *rc::gen::inRange(-5, 6);
  model.run(std::vector<Step>(20));
  model.run({{sudden, amount}});
  model.run(std::vector<Step>(20));
  RC_ASSERT(model.wrong == 0U);
  RC_ASSERT(model.longest_unnamed <= 2U);
}

}  // namespace
