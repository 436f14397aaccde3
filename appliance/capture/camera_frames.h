#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/dma_buf.h"
#include "rt/pin_budget.h"
#include "rt/slot_pool.h"

namespace appliance {

/// What is known of a stored frame besides its pixels.
struct StoredFrame {
  std::uint64_t trigger = 0;
  std::uint64_t frame_id = 0;
  std::uint64_t number = 0;    ///< counts the camera's stored frames from 1; set by store()
  rt::Timestamp trigger_edge;  ///< when the pulse left; it stays known as long as the frame
  rt::Timestamp first_packet;
  rt::Timestamp last_packet;
};

/// A reader's pin on one frame. It counts against the reader's budget. One made without a slot
/// holds nothing.
///
/// Threads  One at a time; it may move to another thread.
/// RT       RT safe.
class FramePin {
 public:
  FramePin() noexcept = default;
  /// @pre one pin of @p budget was spent on it
  FramePin(rt::SlotPin slot, rt::PinBudget& budget) noexcept
      : slot_(std::move(slot)), budget_(&budget) {}
  FramePin(FramePin&& other) noexcept
      : slot_(std::move(other.slot_)), budget_(std::exchange(other.budget_, nullptr)) {}
  FramePin& operator=(FramePin&& other) noexcept {
    FramePin taken(std::move(other));  // drops what this held on return
    std::swap(slot_, taken.slot_);
    std::swap(budget_, taken.budget_);
    return *this;
  }
  ~FramePin() {
    slot_ = {};  // before the budget has room for the next pin
    if (budget_ != nullptr) budget_->giveBack();
  }

  /// A second pin on the same frame, even if newer frames have overtaken it; nothing beyond the
  /// budget.
  [[nodiscard]] std::optional<FramePin> tryAgain() const RT_SAFE;

  /// For tests: which slot it is.
  [[nodiscard]] std::uint32_t slot() const RT_SAFE { return slot_.slot(); }

 private:
  rt::SlotPin slot_;
  rt::PinBudget* budget_ = nullptr;  // none: holds nothing, or was moved from
};

/// A stored frame that cannot be overwritten while this object lives.
struct PinnedFrame {
  FramePin pin;
  const std::byte* pixels = nullptr;
  rt::DmaBufPart dma_buf;  ///< the same bytes, if the history is shared
  StoredFrame frame;

  /// See FramePin::tryAgain().
  [[nodiscard]] std::optional<PinnedFrame> tryAgain() const RT_SAFE;
};

/// The last frames of one camera, each in the slot into which the camera delivered it.
///
/// A slot is in exactly one state: free, filling (the camera writes into it), stored (readers
/// find it by its trigger) or parked (newer frames have overtaken it, and a reader still pins
/// it). Readers pin, the writer retires; the slot's own state word decides between them, so the
/// camera never gets a pinned slot.
///
/// Threads  store(): the camera's receive thread; a restarted camera's thread follows the old
///          one's. The others: any thread.
/// RT       store() is wait-free, tryPin() lock-free. Nothing allocates.
/// Errors   store() drops the new frame if no slot is free. That happens only if readers hold
///          more pins than there are spare slots; FrameHistory's budgets exclude it.
class CameraFrames {
 public:
  /// @p slots: memory of sets + in_flight frames, one more, and one per pin that readers may hold
  /// together; @p dma_bufs: beside them, or empty.
  CameraFrames(std::vector<std::span<std::byte>> slots, std::vector<rt::DmaBufPart> dma_bufs,
               std::uint32_t sets, std::uint32_t in_flight);

  [[nodiscard]] std::span<const std::span<std::byte>> slots() const { return slots_; }

  /// The slots that the camera fills, `in_flight` at any time: a stream that ended amid
  /// some frames leaves exactly these to the next one.
  /// Threads  The one that starts and stops the camera, while it is stopped.
  [[nodiscard]] std::span<const std::uint32_t> fillingSlots() const { return filling_; }

  /// How many sets are kept.
  [[nodiscard]] std::uint32_t sets() const RT_SAFE {
    return static_cast<std::uint32_t>(places_.size());
  }

  /// Makes the filled slot readable as frame.trigger, in place of the oldest set's frame, and
  /// returns the slot to fill next. It is @p slot itself if no other one is free: then nothing was
  /// stored, and the caller counts the frame. Triggers only grow.
  [[nodiscard]] std::uint32_t store(std::uint32_t slot, const StoredFrame& frame) RT_SAFE;

  /// The frame of that trigger; nothing if it never came, if newer ones have overtaken it, or if
  /// @p budget is used up (which the budget counts).
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint64_t trigger,
                                                  rt::PinBudget& budget) RT_SAFE;

  /// Whether tryPin() would have found the frame a moment ago.
  [[nodiscard]] bool holds(std::uint64_t trigger) const RT_SAFE;

  /// Triggers of the newest stored frame and of the oldest that may still be stored; 0 before
  /// the first.
  [[nodiscard]] std::uint64_t newest() const RT_SAFE {
    return newest_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::uint64_t oldest() const RT_SAFE;

 private:
  std::vector<std::span<std::byte>> slots_;
  std::vector<rt::DmaBufPart> dma_bufs_;            // beside slots_, or empty
  std::vector<StoredFrame> frames_;                 // beside slots_; guarded by the slot's state
  std::vector<std::atomic<std::uint64_t>> places_;  // set index -> trigger and slot
  rt::SlotPool pool_;
  std::vector<std::uint32_t> filling_;   // in_flight of them: searched at every frame
  std::uint64_t stored_ = 0;             // frames so far
  std::atomic<std::uint64_t> first_{0};  // trigger of the first frame ever stored
  std::atomic<std::uint64_t> newest_{0};
};

/// A camera's slots are numbered with so many bits.
inline constexpr int kSlotBits = 16;
/// So there are at most so many.
inline constexpr std::size_t kMostSlots = (std::size_t{1} << kSlotBits) - 1;

}  // namespace appliance
