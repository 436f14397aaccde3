#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/genlock_status.h"
#include "hal/display_timing.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// What the render thread knows and the trigger loop needs.
struct GenlockInput {
  std::optional<hal::DisplayTiming> timing;
  rt::Nanoseconds ready_delay{};  ///< trigger_edge to frame_ready, nearly always; zero: not known
};

/// Moves the triggers so that every frame is ready just in time for the same vblank.
///
/// A picture comes on screen with vblank v if its warp begins by latestStart(v). Its frame is
/// ready a `ready_delay` after the trigger, so the trigger belongs at
///
///     vblankAt(v) - lead,   lead = ready_delay + margin + draw + commit_margin
///
/// and the next one n vblanks later, n = round(period / vblank period). Per trigger, a deadline
/// moves by at most kMostSlew of a period plus the difference of the two rates (at most
/// kMostMistuned): cameras need that much headroom. The lead follows its parts slowly, so that
/// their changes never break a lock. The mains frequency is not used: exposure and gain handle
/// lamps.
///
/// Threads  One: the trigger loop's. Pure: time is an argument.
/// RT       RT safe.
class Genlock {
 public:
  struct Parameters {
    bool enabled = true;
    rt::Nanoseconds period;  ///< as configured
    rt::Nanoseconds margin;  ///< frame_ready to the latest start of its warp
  };

  static constexpr double kMostMistuned =
      0.005;                                 ///< n vblanks from the configured period, relative
  static constexpr double kMostSlew = 0.01;  ///< of a period, per trigger
  static constexpr rt::Nanoseconds kHoldOver = std::chrono::seconds(60);

  explicit Genlock(const Parameters& parameters);

  /// Takes the newest input. If it has no timing, the last timing is held over.
  void take(const GenlockInput& input) RT_SAFE;

  /// How far the coming deadline, one configured period after the last, is to be moved.
  /// Once per trigger.
  [[nodiscard]] rt::Nanoseconds step(rt::Timestamp deadline) RT_SAFE;

  [[nodiscard]] const GenlockStatus& status() const RT_SAFE { return status_; }

 private:
  [[nodiscard]] GenlockReason obstacle(rt::Timestamp deadline) const RT_SAFE;
  [[nodiscard]] rt::Nanoseconds moveLead() RT_SAFE;
  void judge(rt::Nanoseconds error) RT_SAFE;
  void leave(GenlockState to, GenlockReason reason) RT_SAFE;

  const Parameters parameters_;
  GenlockInput input_;
  GenlockStatus status_;
  bool lead_moving_ = false;
  std::uint32_t good_in_a_row_ = 0;
  std::uint32_t locked_for_ = 0;  // triggers
};

}  // namespace appliance
