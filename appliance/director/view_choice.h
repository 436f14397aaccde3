#pragma once

#include <cstdint>
#include <optional>

#include "appliance/director/available.h"
#include "appliance/director/steady_views.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// Which camera's frame shows the wanted view of a moment: its own, or that of the nearest usable
/// neighbour. Of two equally near ones the side shown before stays, else left.
///
/// live     a camera that delivers; one that failed counts again once it is steady.
/// played   a frame of the moment; a missing one is bridged by the view's previous ones, because a
///          repeated picture is not seen and a jump of the view is. Only steady views count.
/// stopped  a frame of exactly the moment, from any camera.
///
/// Threads  One: the render thread.
/// RT       RT safe; a few hundred calls of StoredViews.
class ViewChoice {
 public:
  static constexpr std::uint64_t kBridgedTriggers = 3;
  /// Moments around a hole in all cameras' memory that are tried in its place.
  static constexpr std::uint64_t kWidestHole_triggers = 32;

  struct Frame {
    std::uint32_t camera = 0;
    std::uint64_t trigger = 0;
  };

  /// Another stretch of time is shown from now on.
  void reset() RT_SAFE { steady_.reset(); }

  [[nodiscard]] std::optional<Frame> live(const Available& at, std::uint32_t view,
                                          const Frame& last, rt::Timestamp now) RT_SAFE;
  [[nodiscard]] std::optional<Frame> played(const Available& at, std::uint32_t view,
                                            const Frame& last, std::uint64_t trigger,
                                            rt::Timestamp now) RT_SAFE;
  [[nodiscard]] static std::optional<Frame> stopped(const Available& at, std::uint32_t view,
                                                    const Frame& last,
                                                    std::uint64_t trigger) RT_SAFE;

 private:
  SteadyViews steady_;
};

}  // namespace appliance
