#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "appliance/depth/depth_reader.h"
#include "hal/depth_sensor.h"
#include "rt/clock.h"
#include "rt/slot_pool.h"

namespace appliance {

/// The newest pairs of the depth sensor, for many readers.
///
/// The sensor lends a pair to one caller until the next call. The depth loop is this caller: it
/// copies each pair once, into a slot, and from then on readers share the slot. A reader that
/// keeps its pins forever runs out of its own budget; the writer and the other readers never
/// notice.
///
/// Threads  openReader(): one thread, at set-up. publish(): the `depth` thread. newest(),
///          readers(): any. Each DepthReader has a thread of its own.
/// RT       publish() allocates when the size of the pictures changes. It never waits.
/// Memory   kKept pairs, one that is being filled, and one for each pin that is held.
class DepthBoard {
 public:
  static constexpr std::uint32_t kKept = 8;       ///< pairs: a quarter of a second at 30 Hz
  static constexpr std::uint32_t kMostPins = 16;  ///< the budgets of all readers together
  static constexpr std::size_t kMostReaders = 8;

  DepthBoard() : pool_(kSlots), slots_(kSlots) {}

  /// A reader that may hold @p pins pairs at the same time.
  /// Errors   One line: there are too many readers, or their budgets exceed kMostPins.
  [[nodiscard]] std::expected<DepthReader*, std::string> openReader(std::string name,
                                                                    std::uint32_t pins);

  /// Copies the pair and shows it to the readers, in place of the oldest one.
  void publish(const hal::DepthFrame& frame);

  /// The number of the newest pair; 0 before the first.
  [[nodiscard]] std::uint64_t newest() const noexcept {
    return newest_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::vector<DepthReaderStatus> readers() const;

 private:
  friend class DepthReader;

  static constexpr std::uint32_t kSlots = kKept + 1 + kMostPins;
  struct Slot {
    StoredDepth picture;
    std::vector<std::uint16_t> depth_mm;
    std::vector<std::uint8_t> colour_rgb;
  };
  struct Found {
    rt::SlotPin pin;
    const Slot* slot;
  };

  [[nodiscard]] std::uint64_t oldest() const noexcept;
  [[nodiscard]] std::optional<Found> tryFind(std::uint64_t number) noexcept;

  rt::SlotPool pool_;
  std::vector<Slot> slots_;
  std::array<std::atomic<std::uint64_t>, kKept> places_{};  // a pair's number and its slot
  std::atomic<std::uint64_t> newest_{0};

  std::uint32_t budgeted_pins_ = 0;
  std::array<std::unique_ptr<DepthReader>, kMostReaders> readers_;
  std::atomic<std::size_t> reader_count_{0};
};

}  // namespace appliance
