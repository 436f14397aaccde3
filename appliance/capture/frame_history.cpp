#include "appliance/capture/frame_history.h"

#include <span>
#include <utility>

namespace appliance {
namespace {

constexpr std::size_t kPageBytes = 4096;  // slots begin on a page, so each can be shared alone

std::size_t wholePages(std::size_t bytes) {
  return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

}  // namespace

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
  if (layout.slots() > kMostSlots)
    return std::unexpected(withId(phrase<Word::kHistorySlots>(layout.slots(), kMostSlots)));
  const auto backing = sharing == HistorySharing::kShared ? rt::ArenaBacking::kMemoryFile
                                                          : rt::ArenaBacking::kPrivate;
  auto arena = rt::LockedArena::create(layout.bytes(), rt::LockedArena::kMarginBytes, backing);
  if (!arena) {
    return std::unexpected(withId(phrase<Word::kHistoryMemory>(
        static_cast<double>(layout.bytes()) * 1e-9, arena.error().where)));
  }
  return std::unique_ptr<FrameHistory>(new FrameHistory(std::move(*arena), layout, sharing));
}

FrameHistory::FrameHistory(rt::LockedArena arena, const HistoryLayout& layout,
                           HistorySharing sharing)
    : arena_(std::move(arena)), sets_(layout.sets), unclaimed_pins_(layout.reserve) {
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

std::expected<FrameReader*, std::string> FrameHistory::openReader(std::string name,
                                                                  std::uint32_t pins_per_camera) {
  if (pins_per_camera > unclaimed_pins_) {
    return std::unexpected(
        withId(phrase<Word::kHistoryPins>(name, pins_per_camera, unclaimed_pins_)));
  }
  unclaimed_pins_ -= pins_per_camera;
  readers_.push_back(std::make_unique<FrameReader>(*this, std::move(name), pins_per_camera));
  return readers_.back().get();
}

std::vector<ReaderReport> FrameHistory::readers() const {
  std::vector<ReaderReport> reports;
  for (const auto& reader : readers_) reports.push_back(reader->report());
  return reports;
}

std::vector<Phrase> FrameHistory::remarks() const {
  std::vector<Phrase> remarks;
  for (const ReaderReport& reader : readers()) {
    if (reader.refused == 0) continue;
    remarks.push_back(phrase<Word::kHistoryRefused>(reader.name, reader.pins_per_camera));
  }
  return remarks;
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
