#include "ui-kms/scanout_queue.h"

#include <algorithm>
#include <cassert>

namespace ui {

std::optional<std::uint32_t> ScanoutQueue::find(BufferState wanted) const {
  const auto found = std::ranges::find(states_, wanted);
  if (found == states_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - states_.begin());
}

rt::Result<std::uint32_t> ScanoutQueue::tryBeginDraw() const {
  if (const auto again = drawn()) return *again;
  if (const auto free = find(BufferState::kFree)) return *free;
  return std::unexpected(rt::Error{rt::Errc::kBusy, 0, "render: no buffer is free"});
}

void ScanoutQueue::finishDraw(std::uint32_t buffer) {
  states_[buffer] = BufferState::kDrawn;
}

bool ScanoutQueue::takesCommit() const {
  return !pending() || (depth_ == 2 && !queued());
}

void ScanoutQueue::commit(std::uint32_t buffer) {
  committed_ = buffer;
  committed_flip_.reset();
}

void ScanoutQueue::queue(std::uint32_t buffer, std::uint64_t picture_id) {
  assert(pending() && takesCommit());
  states_[buffer] = BufferState::kQueued;
  queued_picture_ = picture_id;
  commit(buffer);
}

std::optional<ScanoutQueue::Due> ScanoutQueue::due() const {
  const auto queued = find(BufferState::kQueued);
  if (!queued || pending()) return std::nullopt;
  return Due{.buffer = *queued, .picture_id = queued_picture_};
}

void ScanoutQueue::submitted(std::uint32_t buffer, std::uint64_t picture_id, std::uint64_t serial) {
  assert(!pending());
  if (states_[buffer] != BufferState::kQueued) commit(buffer);
  states_[buffer] = BufferState::kPending;
  pending_picture_ = picture_id;
  pending_serial_ = serial;
}

std::optional<std::uint32_t> ScanoutQueue::pendingBuffer(std::uint64_t serial) const {
  return serial == pending_serial_ ? find(BufferState::kPending) : std::nullopt;
}

void ScanoutQueue::onFlip(std::uint64_t serial, std::uint64_t vblank, rt::Timestamp at) {
  const auto flipped = pendingBuffer(serial);
  if (!flipped) return;
  if (const auto before = find(BufferState::kOnScreen)) states_[*before] = BufferState::kFree;
  states_[*flipped] = BufferState::kOnScreen;
  const hal::PageFlip flip{.picture_id = pending_picture_, .page_flip = at, .vblank = vblank};
  if (committed_ == flipped) committed_flip_ = flip;
  flips_[(first_flip_ + flip_count_) % kFlipsKept] = flip;
  if (flip_count_ == kFlipsKept) {
    first_flip_ = (first_flip_ + 1) % kFlipsKept;
  } else {
    ++flip_count_;
  }
}

void ScanoutQueue::dropAll() {
  std::ranges::fill(states_, BufferState::kFree);
  committed_.reset();
  committed_flip_.reset();
}

std::optional<hal::PageFlip> ScanoutQueue::tryPopFlip() {
  if (flip_count_ == 0) return std::nullopt;
  const hal::PageFlip flip = flips_[first_flip_];
  first_flip_ = (first_flip_ + 1) % kFlipsKept;
  --flip_count_;
  return flip;
}

}  // namespace ui
