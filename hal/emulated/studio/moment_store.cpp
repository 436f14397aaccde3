#include "hal/emulated/studio/moment_store.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace emulator::studio {
namespace {

/// What @p by_turn has of the turns of @p block.
template <typename T>
std::span<T> ofBlock(std::vector<T>& by_turn, std::uint32_t block) {
  const std::size_t first = std::size_t{block} * MomentStore::kBlock;
  return std::span(by_turn).subspan(
      first, std::min<std::size_t>(MomentStore::kBlock, by_turn.size() - first));
}

}  // namespace

MomentStore::MomentStore(std::vector<std::uint32_t> order, std::uint32_t moments)
    : order_(std::move(order)), overlays_(moments) {
  if (order_.empty()) {
    order_.resize(moments);
    std::iota(order_.begin(), order_.end(), 0u);
  }
  patches_.resize(order_.size());
  turns_.resize(order_.size());
  packed_.resize((order_.size() + kBlock - 1) / kBlock);
}

std::span<MomentPatches> MomentStore::patchesOfBlock(std::uint32_t block) {
  return ofBlock(patches_, block);
}

std::optional<std::uint32_t> MomentStore::take() {
  const std::lock_guard lock(mutex_);
  const auto open = std::ranges::find(turns_, Turn::kOpen);
  if (open == turns_.end()) return std::nullopt;
  *open = Turn::kTaken;
  return static_cast<std::uint32_t>(open - turns_.begin());
}

void MomentStore::giveBack(std::uint32_t turn) {
  const std::lock_guard lock(mutex_);
  turns_[turn] = Turn::kOpen;
}

bool MomentStore::finish(std::uint32_t turn) {
  const std::lock_guard lock(mutex_);
  turns_[turn] = Turn::kDrawn;
  return std::ranges::all_of(ofBlock(turns_, blockOf(turn)),
                             [](Turn one) { return one == Turn::kDrawn; });
}

bool MomentStore::settle(std::uint32_t block) {
  const auto drawn = patchesOfBlock(block);
  auto packed = packMoments(drawn);
  if (!packed) {
    full_ = true;
    return false;
  }
  for (std::uint32_t i = 0; i < drawn.size(); ++i) {
    overlays_[order_[block * kBlock + i]] = std::move(packed->overlays[i]);
    drawn[i] = {};
  }
  const std::lock_guard lock(mutex_);
  packed_[block] = std::move(*packed);
  const auto gap = std::ranges::find_if(packed_, [](const auto& one) { return !one.has_value(); });
  const auto blocks = static_cast<std::uint32_t>(gap - packed_.begin());
  ready_.store(std::min(blocks * kBlock, turns()), std::memory_order_release);
  return true;
}

}  // namespace emulator::studio
