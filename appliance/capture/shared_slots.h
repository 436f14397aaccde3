#pragma once

#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "rt/dma_buf.h"
#include "rt/memory.h"

namespace appliance {

/// Neighbouring slots that share a dma-buf.
struct SlotBlock {
  std::size_t first_slot = 0;
  std::size_t slots = 0;
  std::size_t offset_bytes = 0;  ///< of the first slot, in the arena
  std::size_t bytes = 0;
};

/// As few blocks as slots of @p slot_bytes, one after the other, allow: none larger than
/// @p most_bytes, no slot in two. Nothing if a single slot is larger.
[[nodiscard]] std::vector<SlotBlock> planBlocks(std::span<const std::size_t> slot_bytes,
                                                std::size_t most_bytes);

/// The slots of an arena as parts of dma-bufs, for a GPU that reads them in place. Many to a
/// dma-buf: twenty rings of 300 would otherwise take 6,000 file descriptors.
///
/// Threads  create(): a SCHED_OTHER thread. part(): any.
/// RT       part() is RT safe.
/// Errors   create(): one line; the slots serve as before, but no GPU can import them.
class SharedSlots {
 public:
  /// @p slot_bytes: whole pages each, from the arena's beginning, one after the other.
  [[nodiscard]] static std::expected<SharedSlots, std::string> create(
      const rt::LockedArena& arena, std::span<const std::size_t> slot_bytes);

  [[nodiscard]] const rt::DmaBufPart& part(std::size_t slot) const { return parts_[slot]; }

 private:
  std::vector<rt::DmaBuf> buffers_;
  std::vector<rt::DmaBufPart> parts_;
};

}  // namespace appliance
