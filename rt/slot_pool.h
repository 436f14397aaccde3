#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "rt/annotations.h"

namespace rt {

/// Who may touch one slot of big data, in one atomic word: {tag, published, pins}.
///
///     free, filling --publish(tag)--> stored --retire()--> free            (no pin left)
///                                            \-> parked --unpin()--> free  (the last pin goes)
///
/// A pin succeeds only while the slot is stored under the tag that the reader names.
/// The writer gets a slot back only if the slot is neither stored nor pinned.
///
/// Threads  publish(), retire(), isFree(): the writer. The others: any.
/// RT       Lock-free; the writer's members are wait-free.
/// Memory   publish() releases the slot's content to a successful tryPin(). unpin()
///          releases the reader's last look to the writer that finds the slot free.
///          tryPin() releases, too: a writer that meets the new pin sees that the pins
///          which the reader dropped before are gone.
class SlotState {
 public:
  static constexpr std::uint64_t kMaxTag = (std::uint64_t{1} << 48) - 1;
  static constexpr std::uint64_t kMaxPins = (std::uint64_t{1} << 15) - 1;

  /// @pre isFree(), tag <= kMaxTag
  void publish(std::uint64_t tag) RT_SAFE {
    assert(isFree() && tag <= kMaxTag);
    word_.store(published(tag), std::memory_order_release);
  }

  /// False when the slot holds something else by now (or kMaxPins are held).
  [[nodiscard]] bool tryPin(std::uint64_t tag) RT_SAFE {
    auto word = word_.load(std::memory_order_relaxed);
    while ((word & ~kMaxPins) == published(tag) && (word & kMaxPins) != kMaxPins) {
      if (word_.compare_exchange_weak(word, word + 1, std::memory_order_acq_rel,
                                      std::memory_order_relaxed)) {
        return true;
      }
    }
    return false;
  }

  /// One more pin on what is pinned already, whether it is still stored or not.
  /// @pre the caller holds a pin
  void pinAgain() RT_SAFE {
    [[maybe_unused]] const auto before = word_.fetch_add(1, std::memory_order_relaxed);
    assert((before & kMaxPins) != 0 && (before & kMaxPins) != kMaxPins);
  }

  /// @pre the caller holds a pin
  void unpin() RT_SAFE {
    [[maybe_unused]] const auto before = word_.fetch_sub(1, std::memory_order_release);
    assert((before & kMaxPins) != 0);
  }

  /// No new pin from now on. True when none is left: the slot is free.
  [[nodiscard]] bool retire() RT_SAFE {
    return (word_.fetch_and(~kPublished, std::memory_order_acquire) & kMaxPins) == 0;
  }

  [[nodiscard]] bool isFree() const RT_SAFE {
    return (word_.load(std::memory_order_acquire) & (kPublished | kMaxPins)) == 0;
  }

 private:
  static constexpr std::uint64_t kPublished = std::uint64_t{1} << 15;  // above the pin count
  static constexpr int kTagShift = 16;

  static constexpr std::uint64_t published(std::uint64_t tag) noexcept {
    return (tag << kTagShift) | kPublished;
  }

  std::atomic<std::uint64_t> word_{0};
};

/// Holds a slot's content in place while it lives. One made without a slot holds nothing.
/// Threads  One at a time; it may move to another thread.
/// RT       Wait-free to move, to repeat and to destroy.
class SlotPin {
 public:
  SlotPin() noexcept = default;
  SlotPin(SlotState& state, std::uint32_t slot) noexcept : state_(&state), slot_(slot) {}
  SlotPin(SlotPin&& other) noexcept
      : state_(std::exchange(other.state_, nullptr)), slot_(other.slot_) {}
  SlotPin& operator=(SlotPin&& other) noexcept {
    SlotPin taken(std::move(other));  // drops what this held on return
    std::swap(state_, taken.state_);
    std::swap(slot_, taken.slot_);
    return *this;
  }
  ~SlotPin() {
    if (state_ != nullptr) state_->unpin();
  }

  /// A second pin on the same content.
  [[nodiscard]] SlotPin again() const RT_SAFE {
    if (state_ == nullptr) return {};
    state_->pinAgain();
    return {*state_, slot_};
  }

  [[nodiscard]] std::uint32_t slot() const noexcept { return slot_; }

 private:
  SlotState* state_ = nullptr;  // none: holds nothing, or was moved from
  std::uint32_t slot_ = 0;
};

/// The slots of one writer and the bookkeeping of which are free.
///
/// A retired slot that a reader still holds is parked and collected by a later
/// tryAcquire(): the writer never waits. With as many slots as are filling and
/// stored at the same time, plus one per pin that readers may hold together, tryAcquire()
/// cannot fail: see PinBudget.
///
/// Threads  tryPin(): any. All else: the writer.
/// RT       The constructor allocates; every other member is RT safe. tryAcquire()
///          looks at each parked slot once; tryPin() is lock-free.
/// Errors   tryAcquire() refuses when every slot is in use; the caller counts that.
class SlotPool {
 public:
  explicit SlotPool(std::uint32_t slots)
      : size_(slots), states_(std::make_unique<SlotState[]>(slots)) {
    free_.reserve(slots);
    parked_.reserve(slots);
    for (std::uint32_t slot = slots; slot > 0; --slot) free_.push_back(slot - 1);
  }

  [[nodiscard]] std::uint32_t size() const RT_SAFE { return size_; }
  [[nodiscard]] std::size_t freeSlots() const RT_SAFE { return free_.size(); }
  /// Retired, but pinned at the last check.
  [[nodiscard]] std::size_t parkedSlots() const RT_SAFE { return parked_.size(); }

  /// A slot to fill, the writer's alone until publish().
  [[nodiscard]] std::optional<std::uint32_t> tryAcquire() RT_SAFE {
    collectParked();
    if (free_.empty()) return std::nullopt;
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    return slot;
  }

  /// Stores an acquired and filled slot: readers find it under @p tag.
  void publish(std::uint32_t slot, std::uint64_t tag) RT_SAFE {
    assert(slot < size_);
    states_[slot].publish(tag);
  }

  /// Takes a stored slot out of sight; it is free again as soon as no pin is left.
  void retire(std::uint32_t slot) RT_SAFE {
    assert(slot < size_ && free_.size() + parked_.size() < size_);
    (states_[slot].retire() ? free_ : parked_).push_back(slot);
  }

  /// A pin on @p slot if it is stored under @p tag right now.
  [[nodiscard]] std::optional<SlotPin> tryPin(std::uint32_t slot, std::uint64_t tag) RT_SAFE {
    assert(slot < size_);
    if (!states_[slot].tryPin(tag)) return std::nullopt;
    return SlotPin(states_[slot], slot);
  }

 private:
  void collectParked() noexcept {
    for (std::size_t i = 0; i < parked_.size();) {
      if (!states_[parked_[i]].isFree()) {
        ++i;
        continue;
      }
      free_.push_back(parked_[i]);
      parked_[i] = parked_.back();
      parked_.pop_back();
    }
  }

  std::uint32_t size_;
  std::unique_ptr<SlotState[]> states_;
  std::vector<std::uint32_t> free_;    // capacity size_, so push_back never allocates
  std::vector<std::uint32_t> parked_;  // likewise
};

}  // namespace rt
