#pragma once

#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "rt/clock.h"
#include "rt/high_quantile.h"

namespace ui {

/// Estimates a screen's vblanks from the stamps of its page flips, and how long pictures take.
///
/// A Kalman filter with two states, the instant of a vblank and the period, whose measurement is a
/// flip's stamp (decision 0012, docs/genlock.md). Between two flips the vblank number shows how
/// many periods passed, so lost events cost only time. Covariances are kept in units of
/// the stamps' jitter: the gains depend on the number of flips alone, from the best straight line
/// through the first few to a memory of about 140 vblanks. A stamp that is off counts for three
/// standard deviations at most. A vblank number that goes back, and several stamps in a row an
/// eighth of a period and more off to the same side, are another mode: start again. The first stamp
/// of all is not used: the flip that sets a mode has one that is milliseconds off.
///
/// Threads  One: the display's caller. Pure: time is an argument.
/// RT       RT safe.
class FramePacer {
 public:
  /// @p refresh_hz: the mode's, the first guess; right within 5 %, above 0.
  /// @p commit_margin: how long before a vblank the screen wants its commit.
  explicit FramePacer(double refresh_hz, rt::Nanoseconds commit_margin = {});

  /// Another mode: everything about vblanks is forgotten.
  void restart(double refresh_hz) RT_SAFE;

  /// Every flip, in order; also vblanks learnt of in another way. One seen twice is ignored.
  void onVblank(std::uint64_t vblank, rt::Timestamp stamp) RT_SAFE;

  /// Every picture that was drawn.
  void onPicture(const hal::RenderInstants& instants) RT_SAFE;

  /// None before the first kKnownAfter vblanks after a start.
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const RT_SAFE;

  static constexpr std::uint32_t kKnownAfter = 13;

 private:
  void begin(std::uint64_t vblank, rt::Timestamp stamp) RT_SAFE;
  void predict(double vblanks) RT_SAFE;
  void correct(double innovation_ns) RT_SAFE;

  const rt::Nanoseconds commit_margin_;
  rt::HighQuantile draw_;

  double nominal_ns_;
  std::uint32_t seen_ = 0;    // since the start, the first one included
  int far_off_ = 0;           // stamps in a row far off to one side, negative: early
  std::uint64_t vblank_ = 0;  // the newest
  rt::Timestamp at_;          // its estimated instant
  double period_ns_ = 0;
  double jitter_ns2_ = 0;  // variance of the stamps
  // Covariance of (instant, period), in units of jitter_ns2_.
  double instant_ = 0;
  double both_ = 0;
  double period_ = 0;
};

}  // namespace ui
