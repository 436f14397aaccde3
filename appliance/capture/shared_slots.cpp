#include "appliance/capture/shared_slots.h"

#include <algorithm>
#include <cstring>

namespace appliance {
namespace {

// EGL takes the place of a frame in its dma-buf as a 32-bit number.
constexpr std::size_t kMostBlockBytes = std::size_t{1} << 30U;

std::string refusal(const rt::Error& error, std::size_t made) {
  std::string line = std::string("the frame history cannot be shared: ") + error.where;
  if (error.os_errno != 0) line += std::string(": ") + std::strerror(error.os_errno);
  if (error.os_errno == EMFILE) line += ": raise LimitNOFILE";
  return made == 0 ? line : line + " (after " + std::to_string(made) + " dma-bufs)";
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
    return std::unexpected("the frame history cannot be shared: a frame exceeds " +
                           std::to_string(most_bytes >> 20U) +
                           " MiB: raise the module parameter udmabuf.size_limit_mb");
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
