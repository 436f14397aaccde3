#include "ui-kms/swap_chain.h"

#include <cassert>

namespace ui {

SwapChain::SwapChain(std::uint32_t buffers, FlipGrid grid) : grid_(grid), states_(buffers) {
  assert(buffers >= 2 && "one on screen and one to draw into");
}

void SwapChain::advance(rt::Timestamp now) {
  const auto pending = states_.find(BufferState::kPending);
  if (!pending || now < committed_flip_->page_flip) return;
  states_.setOnScreen(*pending);
  flips_.push(*committed_flip_);
}

rt::Result<std::uint32_t> SwapChain::tryBeginDraw(rt::Timestamp now) {
  advance(now);
  return states_.tryBeginDraw();
}

void SwapChain::finishDraw(std::uint32_t buffer) {
  states_.set(buffer, BufferState::kDrawn);
}

rt::Result<rt::Timestamp> SwapChain::commit(std::uint64_t picture_id, rt::Timestamp now) {
  advance(now);
  const auto drawn = states_.find(BufferState::kDrawn);
  if (!drawn) {
    return std::unexpected(rt::Error{rt::Errc::kUnsupported, 0, "commit: nothing drawn"});
  }
  if (states_.find(BufferState::kPending)) {
    return std::unexpected(rt::Error{rt::Errc::kBusy, 0, "commit: the last has not flipped"});
  }
  states_.set(*drawn, BufferState::kPending);
  committed_ = drawn;
  const std::uint64_t vblank = grid_.firstAfter(now);
  committed_flip_ = hal::PageFlip{picture_id, grid_.at(vblank), vblank};
  return now;
}

std::optional<hal::PageFlip> SwapChain::tryPopFlip(rt::Timestamp now) {
  advance(now);
  return flips_.tryPop();
}

}  // namespace ui
