#include "appliance/geometry/rig_shelf.h"

#include <cassert>
#include <utility>

namespace appliance {
namespace {

std::string sizeText(const RigCamera& camera) {
  return std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px);
}

/// What running camera @p number would have to change; empty: nothing.
Phrase differenceOf(std::size_t number, const RigCamera& running, const RigCamera& next) {
  if (next.name != running.name)
    return phrase<Word::kRigOtherName>(number, next.name, running.name);
  if (next.width_px != running.width_px || next.height_px != running.height_px)
    return phrase<Word::kRigOtherSize>(number, sizeText(running), sizeText(next));
  if (next.pixel_format != running.pixel_format)
    return phrase<Word::kRigOtherFormat>(number, hal::genicamName(running.pixel_format),
                                         hal::genicamName(next.pixel_format));
  return {};
}

}  // namespace

std::expected<void, Phrase> checkReplaces(const Rig& running, const Rig& next) {
  if (next.cameras.size() != running.cameras.size())
    return std::unexpected(
        phrase<Word::kRigOtherCount>(next.cameras.size(), running.cameras.size()));
  for (std::size_t i = 0; i < next.cameras.size(); ++i) {
    const Phrase difference = differenceOf(i + 1, running.cameras[i], next.cameras[i]);
    if (!difference.empty()) return std::unexpected(difference);
  }
  return {};
}

RigShelf::RigShelf(Rig first) {
  const auto slot = pool_.tryAcquire();
  assert(slot);
  rigs_[*slot] = std::move(first);
  pool_.publish(*slot, 1);
  newest_.store(kSlots + *slot, std::memory_order_release);
}

std::expected<std::uint64_t, Phrase> RigShelf::put(Rig next) {
  const std::uint64_t word = newest_.load(std::memory_order_relaxed);
  const auto newest_slot = static_cast<std::uint32_t>(word % kSlots);
  if (auto fits = checkReplaces(rigs_[newest_slot], next); !fits)
    return std::unexpected(fits.error());
  const auto slot = pool_.tryAcquire();
  if (!slot) return std::unexpected(phrase<Word::kRigShelfFull>(kSlots));
  const std::uint64_t revision = word / kSlots + 1;
  rigs_[*slot] = std::move(next);
  pool_.publish(*slot, revision);
  newest_.store(revision * kSlots + *slot, std::memory_order_release);
  pool_.retire(newest_slot);
  return revision;
}

RigPin RigShelf::newest() RT_SAFE {
  for (;;) {
    const std::uint64_t word = newest_.load(std::memory_order_acquire);
    const auto slot = static_cast<std::uint32_t>(word % kSlots);
    const std::uint64_t revision = word / kSlots;
    // The pin fails only if another rig became the newest since the load.
    if (auto pin = pool_.tryPin(slot, revision))
      return RigPin(std::move(*pin), rigs_[slot], revision);
  }
}

}  // namespace appliance
