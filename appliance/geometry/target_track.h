#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "appliance/geometry/hand_targets.h"
#include "appliance/geometry/target_point.h"
#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/shared_value.h"

namespace appliance {

/// Where the target was over time: a ring of measured points, and the points that people set.
///
/// Measurements and points set by hand are two boards with one writer each, so no writer waits for
/// the other or overwrites it. A reader combines them: a point set by hand wins within its range of
/// instants (decision 0019).
///
/// Threads  measure(), revise(): the measuring thread. setByHand(), release(): the thread that
///          carries out commands. Readers: any thread, a TargetReader each.
/// RT       The measuring thread's members are wait-free. Reading leaves no mark.
/// Memory   About 1 MiB. Each entry has its own sequence lock: a reader never sees half of one.
class TargetTrack {
 public:
  /// Two minutes at 60 measurements a second: as long as the longest memory of frames.
  static constexpr std::uint64_t kCapacity = 8192;

  TargetTrack() : slots_(kCapacity) {}

  /// Appends a measurement. @p confidence is between 0 and 1.
  /// False: refused and counted, because it is not newer than the newest or not finite.
  bool measure(rt::Timestamp at, const TargetPoint& point, double confidence) RT_SAFE;
  /// Replaces the measurement of that very instant, for example by a smoothed one.
  /// False: refused and counted, because there is none, or @p point is not finite.
  bool revise(rt::Timestamp at, const TargetPoint& point, double confidence) RT_SAFE;
  [[nodiscard]] std::uint64_t refused() const RT_SAFE {
    return refused_.load(std::memory_order_relaxed);
  }

  /// @p point holds from the instant @p from on; see HandTargets.
  void setByHand(const TargetPoint& point, rt::Timestamp from);
  /// From @p from on measurements count again.
  void release(rt::Timestamp from);

  /// What was measured for @p instant; nothing if it lies before the oldest measurement. The
  /// epoch stands for the newest.
  [[nodiscard]] std::optional<Target> measured(rt::Timestamp instant) const RT_SAFE;

 private:
  friend class TargetReader;

  struct Entry {
    std::uint64_t index = 0;  // of the measurement, from 0: shows an overwritten one
    rt::Timestamp at;
    TargetPoint point;
    double confidence = 0;
    std::uint64_t revision = 0;
  };
  struct Slot {
    rt::SharedValue<Entry> entry;
    std::atomic<std::int64_t> at_ns{0};  // what the search looks at
  };
  struct Window {
    std::uint64_t first = 0;  // the oldest measurement that is safe from being overwritten
    std::uint64_t count = 0;  // one behind the newest
  };

  void put(const Entry& entry) RT_SAFE;
  [[nodiscard]] Window window() const RT_SAFE;
  [[nodiscard]] std::uint64_t firstAfter(rt::Timestamp instant, Window window) const RT_SAFE;
  [[nodiscard]] std::optional<Entry> entry(std::uint64_t index) const RT_SAFE;
  [[nodiscard]] std::optional<Entry> atOrBefore(std::uint64_t index, Window window) const RT_SAFE;
  [[nodiscard]] std::optional<Entry> atOrAfter(std::uint64_t index, Window window) const RT_SAFE;
  [[nodiscard]] Target predicted(const Entry& newest, rt::Timestamp instant,
                                 Window window) const RT_SAFE;

  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::uint64_t revision_ = 0;  // the measuring thread's

  HandTargets hand_;  // the command thread's
  rt::SharedValue<HandTargets> shared_hand_;
};

/// One thread's view of the track.
///
/// Threads  One.
/// RT       at() never waits: while a command is being written, the reader answers by what held
///          before it.
class TargetReader {
 public:
  explicit TargetReader(const TargetTrack& track)
      : track_(track), hand_(track.shared_hand_.load()) {}

  /// The target in the middle of an exposure. There is always an answer: set by hand, else
  /// measured or predicted, else the point set by hand for what comes later, else @p rig_point:
  /// that of the rig which the picture is drawn with. The epoch, an exposure that is not known,
  /// gets the newest.
  [[nodiscard]] Target at(rt::Timestamp exposure_middle, const TargetPoint& rig_point) RT_SAFE;

 private:
  const TargetTrack& track_;
  HandTargets hand_;  // the newest that was read whole
};

}  // namespace appliance
