#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "appliance/director/composition.h"
#include "appliance/director/rate.h"
#include "rt/clock.h"

namespace appliance {

/// What is shown. It follows from the director's state; it is not that state.
enum class Mode : std::uint8_t {
  kLive,
  kDelayed,
  kFrozen,
  kSweep,  ///< frozen, while the view walks along the arc
  kSlow,   ///< stored time, played more slowly than it passed
};

struct ModeRow {
  Mode mode;
  std::string_view name;  ///< in the trace, the status and on the bus
};

inline constexpr std::array<ModeRow, 5> kModes = {{{Mode::kLive, "live"},
                                                   {Mode::kDelayed, "delayed"},
                                                   {Mode::kFrozen, "frozen"},
                                                   {Mode::kSweep, "sweep"},
                                                   {Mode::kSlow, "slow"}}};
static_assert(std::ranges::all_of(kModes, [](const ModeRow& row) {
  return &row == &kModes[static_cast<std::size_t>(row.mode)];
}));

[[nodiscard]] constexpr std::string_view nameOf(Mode mode) {
  return kModes[static_cast<std::size_t>(mode)].name;
}

[[nodiscard]] constexpr std::optional<Mode> modeNamed(std::string_view name) {
  const auto* row = std::ranges::find(kModes, name, &ModeRow::name);
  if (row == kModes.end()) return std::nullopt;
  return row->mode;
}

/// Why another view than the wanted one is shown.
enum class Substitute : std::uint8_t {
  kNone,
  kLost,       ///< the wanted camera sends nothing, or came back less than a second ago
  kNoFrame,    ///< it has no picture of this moment
  kCannotSee,  ///< the target lies outside its picture
};

struct ShownFrame {
  std::uint32_t camera = 0;
  std::uint64_t trigger = 0;  ///< 0: none

  friend bool operator==(const ShownFrame&, const ShownFrame&) = default;
};

/// The director's decision for one output picture: which stored moment of which view.
struct Shot {
  Mode mode = Mode::kLive;
  Substitute substitute = Substitute::kNone;
  bool at_history_end = false;      ///< the moment asked for is no longer (or not yet) stored
  Rate rate = Rate::kFull;          ///< of the playback
  std::uint32_t camera_wanted = 0;  ///< from 0
  std::uint32_t camera_shown = 0;
  std::uint64_t trigger = 0;         ///< 0: nothing is stored that could be shown
  std::uint64_t hold = 0;            ///< the moment whose frames must stay, of all cameras; 0: none
  rt::Nanoseconds delay{};           ///< behind the newest stored moment
  Composition composition;           ///< kSingle whenever there is no second frame
  ShownFrame second;                 ///< drawn after the first, where the composition says
  bool second_missing = false;       ///< a second frame is wanted and not stored
  rt::Nanoseconds second_earlier{};  ///< how long before the first
  std::uint64_t hold_second = 0;     ///< as `hold`, of the second shot; 0: none, or the same moment

  friend bool operator==(const Shot&, const Shot&) = default;
};
static_assert(std::is_trivially_copyable_v<Shot>, "crosses threads");

}  // namespace appliance
