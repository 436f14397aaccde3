#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "hal/depth_sensor.h"
#include "rt/clock.h"
#include "rt/doorbell.h"
#include "rt/slot_pool.h"

namespace appliance {

class DepthBoard;

/// What is known of a stored pair besides its pixels. Trivially copyable.
struct StoredDepth {
  std::uint64_t number = 0;         ///< counted by the board: 1, 2, 3 ...
  std::uint64_t sensor_number = 0;  ///< counted by the sensor: a gap is a lost picture
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  hal::DepthLens lens;
  hal::DepthLens colour_lens;
  rt::Timestamp exposure;
  rt::Timestamp colour_exposure;  ///< the epoch: the pair has no colour
  rt::Timestamp frame_ready;
};

/// One of a reader's pins; given back when this object goes.
class DepthPin {
 public:
  explicit DepthPin(std::atomic<std::uint32_t>& held) : held_(&held) {}
  DepthPin(DepthPin&& other) noexcept : held_(std::exchange(other.held_, nullptr)) {}
  DepthPin& operator=(DepthPin&& other) noexcept {
    std::swap(held_, other.held_);
    return *this;
  }
  ~DepthPin() {
    if (held_ != nullptr) held_->fetch_sub(1, std::memory_order_release);
  }

 private:
  std::atomic<std::uint32_t>* held_;
};

/// A pair that stays as it is while this object lives.
///
/// Threads  One at a time; it may move to another thread.
struct PinnedDepth {
  DepthPin budget;  // goes after the slot's pin: until then the slot counts
  rt::SlotPin pin;
  StoredDepth picture;
  std::span<const std::uint16_t> depth_mm;   ///< row-major, along the axis; 0: nothing measured
  std::span<const std::uint8_t> colour_rgb;  ///< the same size in pixels, sRGB; empty: none
};

struct DepthReaderStatus {
  std::string name;
  std::uint32_t pins = 0;     ///< the budget
  std::uint32_t pinned = 0;   ///< held now
  std::uint64_t taken = 0;    ///< pairs that the reader got
  std::uint64_t lost = 0;     ///< wanted by tryNext(), but overwritten before
  std::uint64_t refused = 0;  ///< asked for while the whole budget was held
};

/// A named reader of the depth board, with a cursor of its own.
///
/// Threads  One, except status(): any.
/// RT       waitUntil() blocks. Everything else is lock-free and does not allocate.
class DepthReader {
 public:
  DepthReader(DepthBoard& board, std::string name, std::uint32_t pins)
      : board_(board), name_(std::move(name)), pins_(pins) {}

  /// The newest pair, if the reader has not got it yet. Pairs between are passed over: a reader
  /// that works with the newest one wants it so.
  [[nodiscard]] std::optional<PinnedDepth> tryNewest() noexcept;
  /// The pair after the last one. Pairs that were overwritten meanwhile are counted as lost.
  [[nodiscard]] std::optional<PinnedDepth> tryNext() noexcept;
  /// Moves the cursor, so that tryNext() begins with the newest @p pairs that the board keeps.
  /// Nothing counts as lost by this.
  void seekBack(std::uint64_t pairs) noexcept;
  /// True as soon as a pair came since the last true; false at @p deadline.
  [[nodiscard]] bool waitUntil(rt::Timestamp deadline) noexcept {
    return bell_.waitUntil(deadline);
  }

  [[nodiscard]] DepthReaderStatus status() const;

 private:
  friend class DepthBoard;

  [[nodiscard]] std::optional<DepthPin> tryBudget() noexcept;
  [[nodiscard]] std::optional<PinnedDepth> tryPin(std::uint64_t number) noexcept;

  DepthBoard& board_;
  const std::string name_;
  const std::uint32_t pins_;
  rt::Doorbell bell_;
  std::uint64_t last_ = 0;  // the pair that the reader got last
  std::atomic<std::uint32_t> held_{0};
  std::atomic<std::uint64_t> taken_{0};  // the reader's thread alone writes these
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace appliance
