#include "appliance/capture/frame_history.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <utility>

namespace appliance {
namespace {

constexpr std::size_t kPageBytes = 4096;  // slots begin on a page, so each can be shared alone

// A place names a trigger and the slot that holds its frame.
constexpr int kSlotBits = 16;
constexpr std::uint64_t place(std::uint64_t trigger, std::uint32_t slot) {
  return trigger << kSlotBits | slot;
}
constexpr std::uint64_t triggerAt(std::uint64_t place) {
  return place >> kSlotBits;
}
constexpr std::uint32_t slotAt(std::uint64_t place) {
  return static_cast<std::uint32_t>(place & ((1U << kSlotBits) - 1));
}

std::size_t wholePages(std::size_t bytes) {
  return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

}  // namespace

CameraFrames::CameraFrames(std::vector<std::span<std::byte>> slots,
                           std::vector<rt::DmaBufPart> dma_bufs, std::uint32_t sets,
                           std::uint32_t in_flight)
    : slots_(std::move(slots)),
      dma_bufs_(std::move(dma_bufs)),
      frames_(slots_.size()),
      places_(sets),
      pool_(static_cast<std::uint32_t>(slots_.size())) {
  assert(slots_.size() > std::size_t{sets} + in_flight && slots_.size() < 1U << kSlotBits);
  assert(dma_bufs_.empty() || dma_bufs_.size() == slots_.size());
  for (std::uint32_t i = 0; i < in_flight; ++i) filling_.push_back(*pool_.tryAcquire());
}

std::uint32_t CameraFrames::store(std::uint32_t slot, const StoredFrame& frame) RT_SAFE {
  assert(frame.trigger > newest());
  std::atomic<std::uint64_t>& where = places_[frame.trigger % places_.size()];
  const std::uint64_t overtaken = where.load(std::memory_order_relaxed);
  if (triggerAt(overtaken) != 0) pool_.retire(slotAt(overtaken));

  frames_[slot] = frame;
  pool_.publish(slot, frame.trigger);
  where.store(place(frame.trigger, slot), std::memory_order_release);
  if (first_.load(std::memory_order_relaxed) == 0) {
    first_.store(frame.trigger, std::memory_order_release);
  }
  newest_.store(frame.trigger, std::memory_order_release);

  const auto next = pool_.tryAcquire();
  assert(next.has_value());  // sets + in flight + all pins fit, by the layout
  const auto handed_back = std::ranges::find(filling_, slot);
  assert(handed_back != filling_.end());
  *handed_back = *next;
  return *next;
}

std::optional<PinnedFrame> CameraFrames::tryPin(std::uint64_t trigger) RT_SAFE {
  const std::uint64_t found = places_[trigger % places_.size()].load(std::memory_order_acquire);
  if (trigger == 0 || triggerAt(found) != trigger) return std::nullopt;
  const std::uint32_t slot = slotAt(found);
  auto pin = pool_.tryPin(slot, trigger);
  if (!pin) return std::nullopt;
  return PinnedFrame{.pin = std::move(*pin),
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

std::size_t HistoryLayout::bytes() const {
  std::size_t sum = 0;
  for (const std::size_t frame : frame_bytes) {
    sum += wholePages(frame) * slots();
  }
  return sum;
}

std::optional<HistoryLayout> fitHistory(HistoryLayout layout, std::size_t available_bytes,
                                        std::uint32_t fewest_sets) {
  while (layout.bytes() > available_bytes) {
    if (layout.sets <= fewest_sets) return std::nullopt;
    --layout.sets;
  }
  return layout;
}

std::expected<std::unique_ptr<FrameHistory>, std::string> FrameHistory::create(
    const HistoryLayout& layout, HistorySharing sharing) {
  const auto backing = sharing == HistorySharing::kShared ? rt::ArenaBacking::kMemoryFile
                                                          : rt::ArenaBacking::kPrivate;
  auto arena = rt::LockedArena::create(layout.bytes(), rt::LockedArena::kMarginBytes, backing);
  if (!arena) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "frame history: %.2f GB of memory are not to be had (%s): lower history.sets",
                  static_cast<double>(layout.bytes()) * 1e-9, arena.error().where);
    return std::unexpected(std::string(line));
  }
  return std::unique_ptr<FrameHistory>(new FrameHistory(std::move(*arena), layout, sharing));
}

FrameHistory::FrameHistory(rt::LockedArena arena, const HistoryLayout& layout,
                           HistorySharing sharing)
    : arena_(std::move(arena)), sets_(layout.sets) {
  if (sharing == HistorySharing::kShared) shared_ = share(layout);
  std::span<std::byte> rest = arena_.bytes();
  std::size_t shared_slot = 0;
  for (const std::size_t frame : layout.frame_bytes) {
    std::vector<std::span<std::byte>> slots(layout.slots());
    std::vector<rt::DmaBufPart> dma_bufs(shared_ ? slots.size() : 0);
    for (auto& slot : slots) {
      slot = rest.first(frame);
      rest = rest.subspan(wholePages(frame));
    }
    for (auto& part : dma_bufs) part = shared_->part(shared_slot++);
    cameras_.push_back(std::make_unique<CameraFrames>(std::move(slots), std::move(dma_bufs),
                                                      layout.sets, layout.in_flight));
  }
}

std::optional<SharedSlots> FrameHistory::share(const HistoryLayout& layout) {
  std::vector<std::size_t> slot_bytes;
  for (const std::size_t frame : layout.frame_bytes) {
    slot_bytes.insert(slot_bytes.end(), layout.slots(), wholePages(frame));
  }
  auto shared = SharedSlots::create(arena_, slot_bytes);
  if (shared) return std::move(*shared);
  not_shared_ = shared.error();
  return std::nullopt;
}

}  // namespace appliance
