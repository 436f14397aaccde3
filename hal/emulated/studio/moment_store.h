#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "hal/emulated/rig/overlay.h"
#include "hal/emulated/studio/packed_moments.h"
#include "hal/emulated/studio/patch.h"

namespace emulator::studio {

/// The moments of a play on their way from open to ready: drawn in turns, packed in blocks.
///
/// Threads  Any, each on turns and blocks of its own; ready(), full() and the overlays of ready
///          moments: any.
/// Memory   Overlays of ready moments stay where they are.
class MomentStore {
 public:
  /// Turns that become ready together.
  static constexpr std::uint32_t kBlock = 4;

  /// @p order: the moments to be drawn, one for every turn; empty: all @p moments in their order.
  MomentStore(std::vector<std::uint32_t> order, std::uint32_t moments);

  [[nodiscard]] std::uint32_t moments() const {
    return static_cast<std::uint32_t>(overlays_.size());
  }
  [[nodiscard]] std::uint32_t turns() const { return static_cast<std::uint32_t>(order_.size()); }
  [[nodiscard]] std::uint32_t momentOf(std::uint32_t turn) const { return order_[turn]; }
  [[nodiscard]] static std::uint32_t blockOf(std::uint32_t turn) { return turn / kBlock; }
  /// What was drawn of a turn, until its block is settled.
  [[nodiscard]] MomentPatches& patches(std::uint32_t turn) { return patches_[turn]; }
  [[nodiscard]] std::span<MomentPatches> patchesOfBlock(std::uint32_t block);

  /// The first turn that is open; the caller's until it is finished or given back.
  [[nodiscard]] std::optional<std::uint32_t> take();
  void giveBack(std::uint32_t turn);
  /// All of it is drawn. True: so is its block, which the caller then settles.
  [[nodiscard]] bool finish(std::uint32_t turn);
  /// Packs a block, which is ready once those before it are. False: there is no memory for it.
  [[nodiscard]] bool settle(std::uint32_t block);

  /// So many turns, from the first on, can be shown.
  [[nodiscard]] std::uint32_t ready() const { return ready_.load(std::memory_order_acquire); }
  /// There is no memory for more moments.
  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] const Overlay& overlay(std::uint32_t moment, std::uint32_t camera) const {
    return overlays_[moment][camera];
  }

 private:
  enum class Turn : std::uint8_t { kOpen, kTaken, kDrawn };

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Overlay>> overlays_;  // by moment and camera
  std::vector<MomentPatches> patches_;          // by turn
  std::mutex mutex_;
  std::vector<Turn> turns_;                           // guarded by mutex_
  std::vector<std::optional<PackedMoments>> packed_;  // by block; guarded by mutex_
  std::atomic<std::uint32_t> ready_ = 0;
  std::atomic<bool> full_ = false;
};

}  // namespace emulator::studio
