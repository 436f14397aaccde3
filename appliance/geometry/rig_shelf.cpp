#include "appliance/geometry/rig_shelf.h"

#include <cassert>
#include <utility>

namespace appliance {
namespace {

std::string sizeText(const RigCamera& camera) {
  return std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px);
}

/// What a running camera would have to change, or empty.
std::string differenceOf(const RigCamera& running, const RigCamera& next) {
  if (next.name != running.name)
    return "is called \"" + next.name + "\" in this rig and \"" + running.name +
           "\" in the running one: keep the cameras' order and names";
  if (next.width_px != running.width_px || next.height_px != running.height_px)
    return "sends " + sizeText(running) + " pixels, this rig says " + sizeText(next) +
           ": calibrate with the running size, or restart kagamid with this rig";
  if (next.pixel_format != running.pixel_format)
    return std::string("sends ") + hal::genicamName(running.pixel_format) + ", this rig says " +
           hal::genicamName(next.pixel_format) + ": restart kagamid with this rig";
  return "";
}

}  // namespace

std::expected<void, std::string> checkReplaces(const Rig& running, const Rig& next) {
  if (next.cameras.size() != running.cameras.size())
    return std::unexpected("this rig has " + std::to_string(next.cameras.size()) + " cameras, " +
                           std::to_string(running.cameras.size()) +
                           " are running: restart kagamid with this rig");
  for (std::size_t i = 0; i < next.cameras.size(); ++i) {
    const std::string difference = differenceOf(running.cameras[i], next.cameras[i]);
    if (!difference.empty())
      return std::unexpected("camera " + std::to_string(i + 1) + " " + difference);
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

std::expected<std::uint64_t, std::string> RigShelf::put(Rig next) {
  const std::uint64_t word = newest_.load(std::memory_order_relaxed);
  const auto newest_slot = static_cast<std::uint32_t>(word % kSlots);
  if (auto fits = checkReplaces(rigs_[newest_slot], next); !fits)
    return std::unexpected(std::move(fits.error()));
  const auto slot = pool_.tryAcquire();
  if (!slot)
    return std::unexpected("all " + std::to_string(kSlots) +
                           " places for rigs are in use: try again in a moment");
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
