#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "appliance/director/move.h"
#include "appliance/director/rate.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// One entry of a programme: what happens when the playhead gets to a moment.
struct Cue {
  std::uint64_t trigger = 0;        ///< the moment
  std::optional<double> angle_deg;  ///< where the view goes; none: it stays
  double speed_deg_per_s = 0;
  double ease = 0;  ///< as Move::ease
  /// The moment rests while the view moves, and this long after it arrived. None: time runs on.
  std::optional<rt::Nanoseconds> hold;
  Rate rate = Rate::kFull;  ///< from then on
};

/// Cues in the order of their moments: the view walks around one moment, time goes on more slowly,
/// and so on. A sweep is three cues of one moment, a replay is two without moves.
///
/// A late step() neither stretches nor shortens anything: what follows a hold begins at the hold's
/// own end.
///
/// Threads  One. Pure: time is an argument.
/// RT       RT safe; trivially copyable.
class Programme {
 public:
  static constexpr std::size_t kMostCues = 32;

  /// False if the programme is full. Cues are added before start().
  [[nodiscard]] bool add(const Cue& cue) RT_SAFE;

  /// @p angle_deg: where the view is.
  void start(double angle_deg) RT_SAFE;

  struct Step {
    Rate rate = Rate::kFull;          ///< kStill: the moment rests
    std::optional<double> angle_deg;  ///< none before the first cue with a way
    bool ended = false;  ///< the last cue has begun, and its hold and its move are over
  };
  /// @p trigger: where the playhead is at @p t.
  [[nodiscard]] Step step(rt::Timestamp t, std::uint64_t trigger) RT_SAFE;

 private:
  void begin(const Cue& cue, rt::Timestamp at) RT_SAFE;

  std::array<Cue, kMostCues> cues_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;  // the first cue that has not begun
  Move move_;             // of the cue that has begun last
  bool resting_ = false;  // in its hold
  bool walks_ = false;    // a cue has moved the view
  Rate rate_ = Rate::kFull;
};

}  // namespace appliance
