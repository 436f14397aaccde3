#include "ui-kms/scanout_queue.h"

#include <cassert>

namespace ui {

void ScanoutQueue::finishDraw(std::uint32_t buffer) {
  states_.set(buffer, BufferState::kDrawn);
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
  states_.set(buffer, BufferState::kQueued);
  queued_picture_ = picture_id;
  commit(buffer);
}

std::optional<ScanoutQueue::Due> ScanoutQueue::due() const {
  const auto queued = states_.find(BufferState::kQueued);
  if (!queued || pending()) return std::nullopt;
  return Due{.buffer = *queued, .picture_id = queued_picture_};
}

void ScanoutQueue::submitted(std::uint32_t buffer, std::uint64_t picture_id, std::uint64_t serial) {
  assert(!pending());
  if (states_[buffer] != BufferState::kQueued) commit(buffer);
  states_.set(buffer, BufferState::kPending);
  pending_picture_ = picture_id;
  pending_serial_ = serial;
}

std::optional<std::uint32_t> ScanoutQueue::pendingBuffer(std::uint64_t serial) const {
  return serial == pending_serial_ ? states_.find(BufferState::kPending) : std::nullopt;
}

void ScanoutQueue::onFlip(std::uint64_t serial, std::uint64_t vblank, rt::Timestamp at) {
  const auto flipped = pendingBuffer(serial);
  if (!flipped) return;
  states_.setOnScreen(*flipped);
  const hal::PageFlip flip{.picture_id = pending_picture_, .page_flip = at, .vblank = vblank};
  if (committed_ == flipped) committed_flip_ = flip;
  flips_.push(flip);
}

void ScanoutQueue::dropAll() {
  states_.setAllFree();
  committed_.reset();
  committed_flip_.reset();
}

std::optional<hal::PageFlip> ScanoutQueue::tryPopFlip() {
  return flips_.tryPop();
}

}  // namespace ui
