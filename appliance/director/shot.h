#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "rt/clock.h"

namespace appliance {

enum class Mode : std::uint8_t {
  kLive,
  kDelayed,
  kFrozen,
  kSweep,  ///< frozen, while the view walks along the arc
};

/// As the trace and the control interface write them, in the order of Mode.
inline constexpr std::array<std::string_view, 4> kModeNames = {"live", "delayed", "frozen",
                                                               "sweep"};

[[nodiscard]] constexpr std::string_view nameOf(Mode mode) {
  return kModeNames[static_cast<std::size_t>(mode)];
}

/// Why another view than the wanted one is shown.
enum class Substitute : std::uint8_t {
  kNone,
  kLost,     ///< the wanted camera sends nothing
  kNoFrame,  ///< it has no picture of this moment
};

/// The director's decision for one output picture: which stored moment of which view.
struct Shot {
  Mode mode = Mode::kLive;
  Substitute substitute = Substitute::kNone;
  bool at_history_end = false;      ///< the moment asked for is no longer (or not yet) stored
  std::uint32_t camera_wanted = 0;  ///< from 0
  std::uint32_t camera_shown = 0;
  std::uint64_t trigger = 0;  ///< 0: nothing is stored that could be shown
  std::uint64_t hold = 0;     ///< the moment whose frames are to stay; 0: none
  rt::Nanoseconds delay{};    ///< behind the newest stored moment

  friend bool operator==(const Shot&, const Shot&) = default;
};
static_assert(std::is_trivially_copyable_v<Shot>, "crosses threads");

}  // namespace appliance
