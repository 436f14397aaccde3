#pragma once

#include <cstdint>
#include <optional>

#include "rt/clock.h"

namespace ui::kms {

/// What a search of the connectors found.
struct Sight {
  bool usable = false;     ///< a screen with at least one mode is connected
  bool unchanged = false;  ///< the screen and mode that are lit are still the choice
  bool link_good = true;
};

/// What to do about the screen, and when: a state machine that a display asks before everything it
/// does. Pure: time is an argument.
///
///                    take master            a look finds one            commit taken
///     (no master) ----------------> kSearching ------------> kLighting ------------> kShowing
///                                        ^  ^---- refused -----'  ^------- changed ------'
///                                        '------------ nothing connected ----------------'
///
/// release() leads from everywhere to kReleased, a vanished device to kLost.
class ScreenMachine {
 public:
  enum class State : std::uint8_t {
    kSearching,  ///< nothing can be shown; looks again and again
    kLighting,   ///< a screen is chosen; the next commit sets its mode
    kShowing,
    kReleased,  ///< given away on request
    kLost,      ///< the device is gone for good
  };
  enum class Task : std::uint8_t {
    kNone,
    kTakeMaster,  ///< answer with onMaster()
    kLook,        ///< ask the connectors, which may take long; answer with onLook()
    kGlance,      ///< what the kernel knows already; answer with onGlance()
  };

  static constexpr rt::Nanoseconds kPoll = std::chrono::seconds(1);
  /// Between tries of a screen that the driver refuses: the first, then doubled up to the last.
  static constexpr rt::Nanoseconds kFirstBackoff = std::chrono::seconds(1);
  static constexpr rt::Nanoseconds kLastBackoff = std::chrono::seconds(8);
  /// A flip that takes longer will not come.
  static constexpr rt::Nanoseconds kFlipPatience = std::chrono::seconds(1);

  explicit ScreenMachine(rt::Timestamp now) : next_(now) {}

  /// What is due at @p now. Do it, answer, and ask again until kNone.
  [[nodiscard]] Task next(rt::Timestamp now);

  void onMaster(bool held, rt::Timestamp now);
  void onLook(const Sight& sight, rt::Timestamp now);
  /// @p unchanged: still connected, link good.
  void onGlance(bool unchanged, rt::Timestamp now);
  /// The kernel said that something about its connectors changed.
  void onHotplug();

  void onCommitted(rt::Timestamp now);
  void onFlip();
  /// The driver does not light this screen, whatever the mode.
  void onRefused(rt::Timestamp now);
  /// A commit for the lit screen failed: its state is not what we think it is.
  void onConfused(rt::Timestamp now);
  void onMasterLost(rt::Timestamp now);
  void onDeviceGone() { enter(State::kLost); }

  void release() { enter(State::kReleased); }
  void take(rt::Timestamp now);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool master() const { return master_; }
  /// Whether pictures are taken.
  [[nodiscard]] bool takesPictures() const {
    return state_ == State::kLighting || state_ == State::kShowing;
  }
  /// Counts what makes the picture on the screen stale: every way into kLighting.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  /// Counts what ends everything that was committed: every way out of kLighting and kShowing.
  [[nodiscard]] std::uint64_t losses() const { return losses_; }

 private:
  void enter(State state);

  State state_ = State::kSearching;
  bool master_ = false;
  bool hotplug_ = false;  // a look is due, whatever next_ says
  rt::Timestamp next_;    // the next task of this state
  rt::Nanoseconds backoff_ = kFirstBackoff;
  std::optional<rt::Timestamp> pending_since_;
  std::uint64_t changes_ = 0;
  std::uint64_t losses_ = 0;
};

}  // namespace ui::kms
