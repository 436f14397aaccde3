#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "appliance/capture/shared_slots.h"
#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/dma_buf.h"
#include "rt/memory.h"
#include "rt/slot_pool.h"

namespace appliance {

/// What is known of a stored frame besides its pixels.
struct StoredFrame {
  std::uint64_t trigger = 0;
  std::uint64_t frame_id = 0;
  rt::Timestamp first_packet;
  rt::Timestamp last_packet;
};

/// A stored frame that cannot be overwritten while this object lives.
struct PinnedFrame {
  rt::SlotPin pin;
  const std::byte* pixels = nullptr;
  rt::DmaBufPart dma_buf;  ///< the same bytes, where the history is shared
  StoredFrame frame;
};

/// The last frames of one camera, each in the slot into which the camera delivered it.
///
/// A slot is in exactly one state: filling (in the camera's hands), stored (readable by its
/// trigger), parked (overtaken by newer frames but still pinned) or free. Readers pin, the
/// writer retires; the slot's own state word decides between them, so a pinned slot cannot
/// come back to the camera.
///
/// Threads  store(): the camera's receive thread, one after the other where the camera is started
///          again. tryPin(), newest(): any thread.
/// RT       store() is wait-free, tryPin() lock-free. Nothing allocates.
/// Memory   All pins of all readers together hold at most `reserve` slots.
class CameraFrames {
 public:
  /// @p slots: memory of sets + in_flight + reserve frames; @p dma_bufs: beside them, or empty.
  CameraFrames(std::vector<std::span<std::byte>> slots, std::vector<rt::DmaBufPart> dma_bufs,
               std::uint32_t sets, std::uint32_t in_flight);

  [[nodiscard]] std::span<const std::span<std::byte>> slots() const { return slots_; }

  /// The slots in the camera's hands, `in_flight` at any time: a stream that ended in the midst of
  /// some frames leaves exactly these to the next one.
  /// Threads  Whoever starts and stops the camera, while it is stopped.
  [[nodiscard]] std::span<const std::uint32_t> fillingSlots() const { return filling_; }

  /// How many sets are kept.
  [[nodiscard]] std::uint32_t sets() const RT_SAFE {
    return static_cast<std::uint32_t>(places_.size());
  }

  /// Makes the filled slot readable as frame.trigger, in place of the oldest set's frame, and
  /// returns the slot to fill next. Triggers only grow.
  [[nodiscard]] std::uint32_t store(std::uint32_t slot, const StoredFrame& frame) RT_SAFE;

  /// The frame of that trigger; nothing if it never came or has been overtaken.
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint64_t trigger) RT_SAFE;

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
  std::vector<std::uint32_t> filling_;   // in_flight of them: looked through at every frame
  std::atomic<std::uint64_t> first_{0};  // trigger of the first frame ever stored
  std::atomic<std::uint64_t> newest_{0};
};

/// How much is kept, in frames per camera.
struct HistoryLayout {
  std::vector<std::size_t> frame_bytes;  ///< per camera
  std::uint32_t sets = 300;              ///< the memory that people see: sets / trigger rate
  std::uint32_t in_flight = 8;           ///< in the cameras' hands
  std::uint32_t reserve = 4;             ///< pinned by readers at once

  [[nodiscard]] std::size_t slots() const { return std::size_t{sets} + in_flight + reserve; }
  /// What the layout takes, every slot rounded up to whole pages.
  [[nodiscard]] std::size_t bytes() const;
};

/// Fewer sets where @p available_bytes is less than the layout asks for; nothing if not even
/// @p fewest_sets fit.
[[nodiscard]] std::optional<HistoryLayout> fitHistory(HistoryLayout layout,
                                                      std::size_t available_bytes,
                                                      std::uint32_t fewest_sets);

/// Whether somebody else, a GPU, reads the frames where they are.
enum class HistorySharing : std::uint8_t { kPrivate, kShared };

/// The frame history of the rig: one block of locked memory, cut into every camera's slots.
///
/// Threads  create(): a SCHED_OTHER thread, blocks for seconds while memory is prefaulted.
class FrameHistory {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<FrameHistory>, std::string> create(
      const HistoryLayout& layout, HistorySharing sharing = HistorySharing::kPrivate);

  [[nodiscard]] CameraFrames& camera(std::uint32_t index) { return *cameras_[index]; }
  [[nodiscard]] const CameraFrames& camera(std::uint32_t index) const { return *cameras_[index]; }
  [[nodiscard]] std::uint32_t cameras() const {
    return static_cast<std::uint32_t>(cameras_.size());
  }
  [[nodiscard]] std::uint32_t sets() const { return sets_; }
  [[nodiscard]] const rt::LockedArena& memory() const { return arena_; }
  /// Why a history that was to be shared is not, in one line; empty otherwise.
  [[nodiscard]] const std::string& notShared() const { return not_shared_; }

 private:
  FrameHistory(rt::LockedArena arena, const HistoryLayout& layout, HistorySharing sharing);
  [[nodiscard]] std::optional<SharedSlots> share(const HistoryLayout& layout);

  rt::LockedArena arena_;
  std::string not_shared_;
  std::optional<SharedSlots> shared_;
  std::uint32_t sets_;
  std::vector<std::unique_ptr<CameraFrames>> cameras_;
};

}  // namespace appliance
