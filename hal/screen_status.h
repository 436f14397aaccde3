#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace hal {

enum class ScreenState : std::uint8_t {
  kShowing,   ///< pictures come on screen
  kNoScreen,  ///< nothing connected, or nothing that can be lit; the display keeps looking
  kReleased,  ///< given to another program on request
};

/// Why a screen shows nothing, or less than configured. What the two texts of ScreenStatus then are
/// is in brackets; a card is named by its path, "/dev/dri/card0".
enum class ScreenTrouble : std::uint8_t {
  kNone,
  kReleased,          ///< given to another program on request
  kCardInUse,         ///< another program shows something [card]
  kCardNotPermitted,  ///< [card]
  kCardGone,          ///< [card]
  kNothingConnected,  ///< [card]
  kNoCrtc,            ///< the card cannot drive this port [connector]
  kNoMode,            ///< the screen offers none [connector]
  kModesRefused,      ///< the driver refused all of them [connector]
  kModeRefused,       ///< the driver refused the one tried, os_errno says why [connector, mode]
  kOtherMode,         ///< display.mode is not offered, another one is shown [connector, mode]
  kNoMemory,          ///< no buffers of the mode's size [-, the driver's own words]
  kNoDisplay,         ///< there is no display for a screen [-, its own words]
};

struct ScreenStatus {
  ScreenState state = ScreenState::kShowing;
  ScreenTrouble trouble = ScreenTrouble::kNone;
  int os_errno = 0;
  std::array<char, 64> subject{};  ///< the card or the connector
  std::array<char, 192> detail{};  ///< the mode, or a driver's own words
  /// Another number than before: the screen no longer shows the last picture, and its mode may be
  /// another. Draw again.
  std::uint64_t changes = 0;
};

/// Copies as much of @p text as has room, and ends it with a zero.
template <std::size_t kBytes>
void putText(std::array<char, kBytes>& to, std::string_view text) {
  to = {};
  std::copy_n(text.begin(), std::min(text.size(), kBytes - 1), to.begin());
}

}  // namespace hal
