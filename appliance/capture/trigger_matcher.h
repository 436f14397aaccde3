#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "appliance/capture/association.h"
#include "appliance/capture/edge_board.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// What a frame says about its trigger.
struct FrameEvidence {
  rt::Timestamp arrival;            ///< when this machine read the leader: late by any time
  rt::Nanoseconds camera_clock{0};  ///< 0: the camera has none
  std::uint64_t frame_id = 0;       ///< grows by one per frame sent, and by jumps
};

/// Which trigger a frame belongs to, or why that is not certain.
struct MatchedTrigger {
  enum class Why : std::uint8_t {
    kMatched,
    kNoEdge,     ///< taken at no trigger's time: a frame that nothing asked for
    kUnsettled,  ///< the camera has just started, or its evidence contradicts itself
  };
  Why why = Why::kMatched;
  std::uint64_t trigger = 0;  ///< 0 unless kMatched
};

/// Finds the trigger of each frame of one camera. It never guesses: a frame whose trigger is not
/// certain gets none.
///
/// Arrival times are unreliable, because this machine may read a frame late by any time. Frame ids
/// are, too: a camera that ignores a trigger counts on without a gap, and one may send a frame that
/// nothing asked for. The camera's clock is reliable. If it read c at one trigger, it reads
/// c + period at the next. So a frame's clock identifies its trigger within a millisecond, and
/// drift (100 ppm: 2.5 us per frame) is followed from frame to frame.
///
/// The clock is learned from three consecutive frames whose clocks agree with the triggers that are
/// nearest to their arrivals. That is wrong only if all three were read more than half a period
/// late. A frame that is nearest to the very first trigger needs no second one: it has no other
/// trigger to belong to. What was learned is dropped when
///
///   - three frames agree on another clock: the camera was started again, or its clock was set;
///   - no frame came for forgottenAfter();
///   - a frame would have arrived before its trigger;
///   - fewer triggers passed than frames were counted.
///
/// After a frame at no trigger's time the clock counts again with the next frame whose arrival
/// agrees with it.
///
/// A camera without a clock is matched by arrivals while frame ids and triggers advance alike.
/// After they did not, three frames must agree again.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free.
class TriggerMatcher {
 public:
  static constexpr unsigned kAgreeing = 3;
  /// How long a clock is believed without a frame. At slow rates 5 s are less than the time from
  /// one frame to the next.
  [[nodiscard]] static constexpr rt::Nanoseconds forgottenAfter(rt::Nanoseconds period) {
    return std::max<rt::Nanoseconds>(std::chrono::seconds(5), 4 * period);
  }
  /// Edges and exposures are that regular, and clocks drift by less within forgottenAfter(). At
  /// fast rates 1 ms would be no less than a period.
  [[nodiscard]] static constexpr rt::Nanoseconds tolerance(rt::Nanoseconds period) {
    return std::min<rt::Nanoseconds>(std::chrono::milliseconds(1), period / 4);
  }

  explicit TriggerMatcher(Association association)
      : association_(association),
        tolerance_(tolerance(association.period())),
        forgotten_after_(forgottenAfter(association.period())) {}

  /// Frames in the order in which they were sent.
  [[nodiscard]] MatchedTrigger match(const FrameEvidence& frame, const EdgeBoard& edges) RT_SAFE;

  /// A new stream begins: forget what was learned of the camera.
  void restart() {
    settled_ = candidate_ = {};
    doubted_ = false;
  }

 private:
  /// What some consecutive frames agree on.
  struct Belief {
    unsigned agreeing = 0;
    rt::Timestamp clock_zero;  // when the camera's clock read zero, if edges and clock are one
    std::uint64_t trigger = 0;
    std::uint64_t frame_id = 0;
    rt::Timestamp arrival;
  };

  [[nodiscard]] std::optional<std::uint64_t> clockFits(const Belief& belief,
                                                       const FrameEvidence& frame,
                                                       const EdgeBoard& edges) const RT_SAFE;
  [[nodiscard]] std::optional<std::uint64_t> countFits(const Belief& belief,
                                                       const FrameEvidence& frame,
                                                       const EdgeBoard& edges) const RT_SAFE;
  [[nodiscard]] std::optional<std::uint64_t> fits(const Belief& belief, const FrameEvidence& frame,
                                                  const EdgeBoard& edges) const RT_SAFE;
  [[nodiscard]] MatchedTrigger relearn(const FrameEvidence& frame, const EdgeBoard& edges,
                                       bool possible) RT_SAFE;

  Association association_;
  rt::Nanoseconds tolerance_;
  rt::Nanoseconds forgotten_after_;
  Belief settled_;        // frames are matched by it; none if none agree
  Belief candidate_;      // what may replace it
  bool doubted_ = false;  // the last frame did not fit what is settled
};

}  // namespace appliance
