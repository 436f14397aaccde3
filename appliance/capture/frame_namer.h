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

/// What a frame brings along to tell its trigger by.
struct FrameEvidence {
  rt::Timestamp arrival;            ///< this machine looked at the leader: late, by any time
  rt::Nanoseconds camera_clock{0};  ///< 0: the camera has none
  std::uint64_t frame_id = 0;       ///< grows by one per frame sent, and by jumps
};

/// Which trigger a frame belongs to, or why that cannot be told.
struct FrameName {
  enum class Why : std::uint8_t {
    kNamed,
    kNoEdge,     ///< taken at no trigger's time: a frame that nothing asked for
    kUnsettled,  ///< the camera has just started, or its evidence contradicts itself
  };
  Why why = Why::kNamed;
  std::uint64_t trigger = 0;  ///< 0 unless kNamed
};

/// Names the trigger of each frame of one camera. A frame that cannot be told is not named:
/// never guessed.
///
/// Frames are late by any time (twenty cameras, few cores), a camera that ignores a trigger counts
/// its frames without a gap, and a camera may send a frame that nothing asked for. What holds is
/// the camera's clock: once it is known what it read at one trigger, it reads one period more at
/// the next. So a frame's clock names its trigger to within a millisecond, however late the frame
/// comes, and drift (100 ppm: 2.5 us per frame) is followed from frame to frame.
///
/// The clock is settled by arrivals: three frames in a row whose clocks agree with the triggers
/// that their arrivals are nearest to. They agree wrongly only if all three were looked at more
/// than half a period late. From the first trigger on there is no doubt: it is the only one. A
/// settled clock is given up for another one that three frames agree on, as when the camera was
/// set or started anew, and after a silence in which it could have drifted too far. What exposes
/// a wrong one, at once: a frame that comes before its trigger can have made it, and triggers
/// that pass more slowly than frames are counted. After a frame at no trigger's time (the camera
/// sent it unasked, or its clock was set) the clock is believed again with a frame whose arrival
/// says the same.
///
/// A camera without a clock is named by arrivals, as long as frame ids and triggers
/// advance alike; after they did not, again only when three frames agree.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free.
class FrameNamer {
 public:
  static constexpr unsigned kAgreeing = 3;
  /// A clock is forgotten after a silence of 5 s, at slow rates after one of some periods:
  /// otherwise no frame would ever meet the clock of the one before.
  [[nodiscard]] static constexpr rt::Nanoseconds forgottenAfter(rt::Nanoseconds period) {
    return std::max<rt::Nanoseconds>(std::chrono::seconds(5), 4 * period);
  }
  /// Edges and exposures are that regular, and clocks differ by less over the time in which they
  /// are not forgotten. At fast rates it is far less than a period.
  [[nodiscard]] static constexpr rt::Nanoseconds tolerance(rt::Nanoseconds period) {
    return std::min<rt::Nanoseconds>(std::chrono::milliseconds(1), period / 4);
  }

  explicit FrameNamer(Association association)
      : association_(association),
        tolerance_(tolerance(association.period())),
        forgotten_after_(forgottenAfter(association.period())) {}

  /// Frames in the order in which they were sent.
  [[nodiscard]] FrameName name(const FrameEvidence& frame, const EdgeBoard& edges) RT_SAFE;

  /// A new stream begins: nothing that was known of the camera needs to hold.
  void restart() {
    settled_ = candidate_ = {};
    doubted_ = false;
  }

 private:
  /// What some frames in a row agree on; the frames count from 0.
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
  [[nodiscard]] FrameName doubt(const FrameEvidence& frame, const EdgeBoard& edges,
                                bool possible) RT_SAFE;

  Association association_;
  rt::Nanoseconds tolerance_;
  rt::Nanoseconds forgotten_after_;
  Belief settled_;        // frames are named by it; none when nobody agrees
  Belief candidate_;      // what may replace it
  bool doubted_ = false;  // the last frame did not fit what is settled
};

}  // namespace appliance
