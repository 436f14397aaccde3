#include "appliance/capture/camera_frames.h"

#include <algorithm>
#include <cassert>

namespace appliance {
namespace {

// A place names a trigger and the slot that holds its frame.
constexpr std::uint64_t place(std::uint64_t trigger, std::uint32_t slot) {
  return trigger << kSlotBits | slot;
}
constexpr std::uint64_t triggerAt(std::uint64_t place) {
  return place >> kSlotBits;
}
constexpr std::uint32_t slotAt(std::uint64_t place) {
  return static_cast<std::uint32_t>(place & ((1U << kSlotBits) - 1));
}

}  // namespace

std::optional<FramePin> FramePin::tryAgain() const RT_SAFE {
  if (budget_ == nullptr) return FramePin{};
  if (!budget_->trySpend()) return std::nullopt;
  return FramePin(slot_.again(), *budget_);
}

std::optional<PinnedFrame> PinnedFrame::tryAgain() const RT_SAFE {
  auto again = pin.tryAgain();
  if (!again) return std::nullopt;
  return PinnedFrame{
      .pin = std::move(*again), .pixels = pixels, .dma_buf = dma_buf, .frame = frame};
}

CameraFrames::CameraFrames(std::vector<std::span<std::byte>> slots,
                           std::vector<rt::DmaBufPart> dma_bufs, std::uint32_t sets,
                           std::uint32_t in_flight)
    : slots_(std::move(slots)),
      dma_bufs_(std::move(dma_bufs)),
      frames_(slots_.size()),
      places_(sets),
      pool_(static_cast<std::uint32_t>(slots_.size())) {
  assert(slots_.size() > std::size_t{sets} + in_flight && slots_.size() <= kMostSlots);
  assert(dma_bufs_.empty() || dma_bufs_.size() == slots_.size());
  for (std::uint32_t i = 0; i < in_flight; ++i) filling_.push_back(*pool_.tryAcquire());
}

std::uint32_t CameraFrames::store(std::uint32_t slot, const StoredFrame& frame) RT_SAFE {
  assert(frame.trigger > newest());
  // First the slot to fill next: if there is none, nothing has changed yet.
  const auto next = pool_.tryAcquire();
  if (!next) return slot;
  const auto handed_back = std::ranges::find(filling_, slot);
  assert(handed_back != filling_.end());
  *handed_back = *next;

  std::atomic<std::uint64_t>& where = places_[frame.trigger % places_.size()];
  const std::uint64_t overtaken = where.load(std::memory_order_relaxed);
  if (triggerAt(overtaken) != 0) pool_.retire(slotAt(overtaken));
  frames_[slot] = frame;
  frames_[slot].number = ++stored_;
  pool_.publish(slot, frame.trigger);
  where.store(place(frame.trigger, slot), std::memory_order_release);
  if (first_.load(std::memory_order_relaxed) == 0) {
    first_.store(frame.trigger, std::memory_order_release);
  }
  newest_.store(frame.trigger, std::memory_order_release);
  return *next;
}

std::optional<PinnedFrame> CameraFrames::tryPin(std::uint64_t trigger,
                                                rt::PinBudget& budget) RT_SAFE {
  const std::uint64_t found = places_[trigger % places_.size()].load(std::memory_order_acquire);
  if (trigger == 0 || triggerAt(found) != trigger || !budget.trySpend()) return std::nullopt;
  const std::uint32_t slot = slotAt(found);
  auto pin = pool_.tryPin(slot, trigger);
  if (!pin) {
    budget.giveBack();
    return std::nullopt;
  }
  return PinnedFrame{.pin = FramePin(std::move(*pin), budget),
                     .pixels = slots_[slot].data(),
                     .dma_buf = dma_bufs_.empty() ? rt::DmaBufPart{} : dma_bufs_[slot],
                     .frame = frames_[slot]};
}

bool CameraFrames::holds(std::uint64_t trigger) const RT_SAFE {
  const std::uint64_t found = places_[trigger % places_.size()].load(std::memory_order_acquire);
  return trigger != 0 && triggerAt(found) == trigger;
}

std::uint64_t CameraFrames::oldest() const RT_SAFE {
  const std::uint64_t newest_stored = newest();
  const std::uint64_t sets = places_.size();
  const std::uint64_t end = newest_stored > sets ? newest_stored - sets + 1 : 1;
  return newest_stored == 0 ? 0 : std::max(end, first_.load(std::memory_order_acquire));
}

}  // namespace appliance
