#include "ui-kms/swap_chain.h"

#include <algorithm>
#include <cassert>

namespace ui {

SwapChain::SwapChain(std::uint32_t buffers, FlipGrid grid)
    : grid_(grid), states_(buffers, BufferState::kFree) {
  assert(buffers >= 2 && "one on screen and one to draw into");
}

std::optional<std::uint32_t> SwapChain::find(BufferState wanted) const {
  const auto found = std::ranges::find(states_, wanted);
  if (found == states_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - states_.begin());
}

void SwapChain::advance(rt::Timestamp now) {
  const auto pending = find(BufferState::kPending);
  if (!pending || now < committed_flip_->page_flip) return;
  if (const auto shown = find(BufferState::kOnScreen)) states_[*shown] = BufferState::kFree;
  states_[*pending] = BufferState::kOnScreen;
  if (flip_count_ == kFlipsKept) {
    first_flip_ = (first_flip_ + 1) % kFlipsKept;
    --flip_count_;
    ++flips_overwritten_;
  }
  flips_[(first_flip_ + flip_count_++) % kFlipsKept] = *committed_flip_;
}

rt::Result<std::uint32_t> SwapChain::tryBeginDraw(rt::Timestamp now) {
  advance(now);
  if (const auto drawn = find(BufferState::kDrawn)) return *drawn;
  if (const auto free = find(BufferState::kFree)) return *free;
  return std::unexpected(rt::Error{rt::Errc::kBusy, 0, "render: no free buffer"});
}

void SwapChain::finishDraw(std::uint32_t buffer) {
  states_[buffer] = BufferState::kDrawn;
}

rt::Result<rt::Timestamp> SwapChain::commit(std::uint64_t picture_id, rt::Timestamp now) {
  advance(now);
  const auto drawn = find(BufferState::kDrawn);
  if (!drawn) {
    return std::unexpected(rt::Error{rt::Errc::kUnsupported, 0, "commit: nothing drawn"});
  }
  if (find(BufferState::kPending)) {
    return std::unexpected(rt::Error{rt::Errc::kBusy, 0, "commit: the last has not flipped"});
  }
  states_[*drawn] = BufferState::kPending;
  committed_ = drawn;
  const std::uint64_t vblank = grid_.firstAfter(now);
  committed_flip_ = hal::PageFlip{picture_id, grid_.at(vblank), vblank};
  return now;
}

std::optional<hal::PageFlip> SwapChain::tryPopFlip(rt::Timestamp now) {
  advance(now);
  if (flip_count_ == 0) return std::nullopt;
  const hal::PageFlip flip = flips_[first_flip_];
  first_flip_ = (first_flip_ + 1) % kFlipsKept;
  --flip_count_;
  return flip;
}

}  // namespace ui
