#include "appliance/capture/frame_history.h"

#include <cstdio>
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
  char line[192];
  if (layout.slots() > kMostSlots) {
    std::snprintf(
        line, sizeof line,
        "frame history: %zu slots per camera (sets, in flight, pinned) are more than %zu: "
        "lower history.sets",
        layout.slots(), kMostSlots);
    return std::unexpected(std::string(line));
  }
  const auto backing = sharing == HistorySharing::kShared ? rt::ArenaBacking::kMemoryFile
                                                          : rt::ArenaBacking::kPrivate;
  auto arena = rt::LockedArena::create(layout.bytes(), rt::LockedArena::kMarginBytes, backing);
  if (!arena) {
    std::snprintf(line, sizeof line,
                  "frame history: needs %.2f GB of memory, which is not available (%s): lower "
                  "history.sets",
                  static_cast<double>(layout.bytes()) * 1e-9, arena.error().where);
    return std::unexpected(std::string(line));
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
    return std::unexpected("frame history: reader \"" + name + "\" asks for " +
                           std::to_string(pins_per_camera) + " pins per camera, " +
                           std::to_string(unclaimed_pins_) +
                           " are left: add its pins to HistoryLayout::reserve");
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

std::vector<std::string> FrameHistory::remarks() const {
  std::vector<std::string> lines;
  for (const ReaderReport& reader : readers()) {
    if (reader.refused == 0) continue;
    lines.push_back("memory: reader \"" + reader.name + "\" wanted more than its " +
                    std::to_string(reader.pins_per_camera) +
                    " frames per camera at once: please report this");
  }
  return lines;
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
