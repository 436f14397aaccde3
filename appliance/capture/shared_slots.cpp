#include "appliance/capture/shared_slots.h"

#include <algorithm>
#include <cstring>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

// EGL takes the offset of a frame in its dma-buf as a 32-bit number.
constexpr std::size_t kMostBlockBytes = std::size_t{1} << 30U;

std::string refusal(const rt::Error& error, std::size_t made) {
  std::string what = error.where;
  if (error.os_errno != 0) what += std::string(": ") + std::strerror(error.os_errno);
  return textOf(error.os_errno == EMFILE ? phrase<Word::kHistoryFileLimit>(made, what)
                                         : phrase<Word::kHistoryNotShared>(made, what));
}

}  // namespace

std::vector<SlotBlock> planBlocks(std::span<const std::size_t> slot_bytes, std::size_t most_bytes) {
  std::vector<SlotBlock> blocks;
  std::size_t offset_bytes = 0;
  for (std::size_t slot = 0; slot < slot_bytes.size(); ++slot) {
    if (slot_bytes[slot] > most_bytes) return {};
    if (blocks.empty() || blocks.back().bytes + slot_bytes[slot] > most_bytes) {
      blocks.push_back({.first_slot = slot, .offset_bytes = offset_bytes});
    }
    ++blocks.back().slots;
    blocks.back().bytes += slot_bytes[slot];
    offset_bytes += slot_bytes[slot];
  }
  return blocks;
}

std::expected<SharedSlots, std::string> SharedSlots::create(
    const rt::LockedArena& arena, std::span<const std::size_t> slot_bytes) {
  const std::size_t most_bytes = std::min(rt::mostDmaBufBytes(), kMostBlockBytes);
  const std::vector<SlotBlock> blocks = planBlocks(slot_bytes, most_bytes);
  if (blocks.empty()) {
    return std::unexpected(textOf(phrase<Word::kHistoryLargeFrame>(most_bytes >> 20U)));
  }
  SharedSlots shared;
  shared.parts_.reserve(slot_bytes.size());
  for (const SlotBlock& block : blocks) {
    auto buffer = rt::DmaBuf::create(arena.memoryFile(), block.offset_bytes, block.bytes);
    if (!buffer) return std::unexpected(refusal(buffer.error(), shared.buffers_.size()));
    std::size_t offset_bytes = 0;
    for (const std::size_t bytes : slot_bytes.subspan(block.first_slot, block.slots)) {
      shared.parts_.push_back(buffer->part(offset_bytes));
      offset_bytes += bytes;
    }
    shared.buffers_.push_back(std::move(*buffer));
  }
  return shared;
}

}  // namespace appliance
