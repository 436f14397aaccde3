#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "appliance/director/composition.h"
#include "appliance/director/rate.h"
#include "rt/clock.h"

namespace appliance {

/// What a person (by the panel) or a program (by the control interface) wants to be shown. Toggles
/// are for buttons; a program names the state it wants, and twice the same changes nothing.
struct Command {
  enum class Kind : std::uint8_t {
    kGoLive,        ///< newest moment, no delay; from every mode
    kHome,          ///< the same, and the rig's middle view
    kFreezeToggle,  ///< stop at the shown moment; again: go on as before
    kDelayLess,     ///< one rung down the delay ladder
    kDelayMore,     ///< one rung up, at most to the memory's end
    kSetDelay,      ///< exactly `delay`; zero is live
    kStepBack,      ///< one trigger earlier; stops first
    kStepForward,
    kViewLeft,  ///< the neighbouring view; the ends of the arc are ends
    kViewRight,
    kSetView,     ///< exactly `camera`
    kSweep,       ///< walk through all views of the stopped moment; stops first. Again: stay there
    kFreeze,      ///< be stopped; ends a sweep where it is
    kThaw,        ///< go on as before the stop
    kStartSweep,  ///< be in a sweep
    kSlower,      ///< play from the shown moment: 1/2, 1/4, 1/8, then at full speed
    kSetRate,     ///< play from the shown moment at `rate`; kStill stops
    kCompare,     ///< lay a second shot beside or over the first: `composition`; kSingle: none
    kReplay,      ///< what was shown in the last `delay`, at `rate`; then go on as before
  };
  /// kCompare: the second shot shows the view that the first one shows.
  static constexpr std::uint32_t kSameView = ~std::uint32_t{0};

  Kind kind = Kind::kGoLive;
  std::uint32_t camera = 0;  ///< kSetView, kCompare (of the second shot), from 0
  rt::Nanoseconds delay{};   ///< kSetDelay, kReplay; kCompare: of the second shot behind the first
  Rate rate = Rate::kFull;   ///< kSetRate, kReplay
  Composition composition;   ///< kCompare

  friend bool operator==(const Command&, const Command&) = default;
};
static_assert(std::is_trivially_copyable_v<Command>, "crosses threads in a ring");

/// More than a person can press between two pictures.
inline constexpr std::size_t kMostCommands = 64;

/// What the director made of a command.
enum class CommandOutcome : std::uint8_t {
  kApplied,
  kNoPictureYet,  ///< there is no moment to stop at or to play from
  kNoSuchView,
  kAtMemorysEnd,  ///< the moment asked for is no longer stored
  kNothingNewer,  ///< the moment asked for has not come yet
};

/// Names a command whose giver waits for its outcome; 0: it does not wait.
using CommandId = std::uint64_t;

/// The outcome of one command, on its way back to its giver.
struct CommandAnswer {
  CommandId id = 0;
  CommandOutcome outcome = CommandOutcome::kApplied;
};

}  // namespace appliance
