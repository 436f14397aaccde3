#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// The last trigger edges, for every thread that searches for the trigger of a frame. The trigger
/// loop reads the clock before and after it drives the line. The edge lies between the two; the
/// board has the middle and its uncertainty.
///
/// Threads  post(): the trigger loop, ids 1, 2, 3 ... in order. Everything else: any thread.
/// RT       Wait-free.
/// Memory   An edge is readable for kCapacity triggers (25 s at 40 Hz), far longer than a
///          frame travels; a reader of an overwritten one gets the epoch. A stored frame keeps its
///          own: StoredFrame::trigger_edge.
class EdgeBoard {
 public:
  /// @p uncertainty: the edge left at most so much before or after @p edge.
  void post(std::uint64_t trigger, rt::Timestamp edge,
            rt::Nanoseconds uncertainty = rt::Nanoseconds{0}) RT_SAFE {
    Entry& entry = entries_[trigger % kCapacity];
    entry.trigger.store(0, std::memory_order_release);  // a reader between the stores finds no id
    entry.edge_ns.store(rt::toNs(edge), std::memory_order_release);
    entry.uncertainty_ns.store(uncertainty.count(), std::memory_order_release);
    entry.trigger.store(trigger, std::memory_order_release);
    newest_.store(trigger, std::memory_order_release);
  }

  /// 0 before the first edge.
  [[nodiscard]] std::uint64_t newest() const RT_SAFE {
    return newest_.load(std::memory_order_acquire);
  }

  /// When that trigger's edge left; the epoch if it is not on the board.
  [[nodiscard]] rt::Timestamp edge(std::uint64_t trigger) const RT_SAFE {
    const Entry& entry = entries_[trigger % kCapacity];
    if (trigger == 0 || entry.trigger.load(std::memory_order_acquire) != trigger) return {};
    const auto edge_ns = entry.edge_ns.load(std::memory_order_acquire);
    if (entry.trigger.load(std::memory_order_acquire) != trigger) return {};
    return rt::fromNs(edge_ns);
  }

  /// The uncertainty of that trigger's edge; 0 if it is not on the board.
  [[nodiscard]] rt::Nanoseconds uncertainty(std::uint64_t trigger) const RT_SAFE {
    const Entry& entry = entries_[trigger % kCapacity];
    if (trigger == 0 || entry.trigger.load(std::memory_order_acquire) != trigger) return {};
    const auto uncertainty_ns = entry.uncertainty_ns.load(std::memory_order_acquire);
    if (entry.trigger.load(std::memory_order_acquire) != trigger) return {};
    return rt::Nanoseconds(uncertainty_ns);
  }

 private:
  static constexpr std::uint64_t kCapacity = 1024;
  struct Entry {
    std::atomic<std::uint64_t> trigger{0};
    std::atomic<std::int64_t> edge_ns{0};
    std::atomic<std::int64_t> uncertainty_ns{0};
  };
  std::array<Entry, kCapacity> entries_{};
  std::atomic<std::uint64_t> newest_{0};
};

}  // namespace appliance
