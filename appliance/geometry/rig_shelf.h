#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <expected>
#include <string>
#include <utility>

#include "appliance/geometry/rig.h"
#include "appliance/words/phrase.h"
#include "rt/annotations.h"
#include "rt/slot_pool.h"

namespace appliance {

/// Whether @p next can replace @p running while the cameras run: as many cameras, of the same
/// names, sizes and pixel formats in the same order. What remains may differ: poses, lenses,
/// colour, the working point.
/// Errors  Which camera, what differs, what to do.
[[nodiscard]] std::expected<void, Phrase> checkReplaces(const Rig& running, const Rig& next);

/// Keeps one rig of the shelf in place while it lives.
/// Threads  One at a time.
/// RT       Wait-free to read, to move and to destroy.
class RigPin {
 public:
  [[nodiscard]] const Rig& operator*() const noexcept { return *rig_; }
  [[nodiscard]] const Rig* operator->() const noexcept { return rig_; }
  /// Counts the rigs of this run from 1. What was computed for another revision is stale.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

 private:
  friend class RigShelf;
  RigPin(rt::SlotPin pin, const Rig& rig, std::uint64_t revision) noexcept
      : pin_(std::move(pin)), rig_(&rig), revision_(revision) {}

  rt::SlotPin pin_;
  const Rig* rig_;
  std::uint64_t revision_;
};

/// The rigs of this run. A rig never changes on the shelf: a better one is put beside it, and
/// every reader from then on gets that one. Its slot is used again when no pin is left on it.
///
/// A reader takes one pin for one piece of work, a picture say, so that no piece of work mixes two
/// rigs. The count, names, sizes and pixel formats of the cameras are those of the first rig.
///
/// Threads  put(): the owner (main). newest(), revision(): any.
/// RT       newest() and revision() are RT safe: newest() repeats only if put() published in
///          between. put() allocates and frees.
/// Errors   put(): one line; the newest rig stays.
class RigShelf {
 public:
  static constexpr std::uint32_t kSlots = 16;
  /// One slot holds the newest rig, one the next while it is put; the others are the readers'.
  static constexpr std::uint32_t kMostPins = kSlots - 2;

  explicit RigShelf(Rig first);

  /// The new revision. Refuses a rig that does not fit, or any while readers hold all slots.
  [[nodiscard]] std::expected<std::uint64_t, Phrase> put(Rig next);

  [[nodiscard]] RigPin newest() RT_SAFE;
  [[nodiscard]] std::uint64_t revision() const RT_SAFE {
    return newest_.load(std::memory_order_acquire) / kSlots;
  }

 private:
  std::array<Rig, kSlots> rigs_;
  rt::SlotPool pool_{kSlots};
  std::atomic<std::uint64_t> newest_{0};  // revision * kSlots + slot
};

}  // namespace appliance
