#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "rt/result.h"

namespace ui {

/// What a buffer is for, and who moves it there: render() draws a free one, commit() makes it
/// pending, the vblank puts it on screen and frees the one before. Queued: committed, but one
/// before it is pending still.
enum class BufferState : std::uint8_t { kFree, kDrawn, kQueued, kPending, kOnScreen };

/// The states of one screen's buffers.
class BufferStates {
 public:
  explicit BufferStates(std::uint32_t buffers) : states_(buffers, BufferState::kFree) {}

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(states_.size()); }
  [[nodiscard]] BufferState operator[](std::uint32_t buffer) const { return states_[buffer]; }
  void set(std::uint32_t buffer, BufferState state) { states_[buffer] = state; }
  void setAllFree() { std::ranges::fill(states_, BufferState::kFree); }
  /// The pending one came on screen: the one before is free.
  void setOnScreen(std::uint32_t buffer) {
    if (const auto before = find(BufferState::kOnScreen)) set(*before, BufferState::kFree);
    set(buffer, BufferState::kOnScreen);
  }

  [[nodiscard]] std::optional<std::uint32_t> find(BufferState wanted) const {
    const auto found = std::ranges::find(states_, wanted);
    if (found == states_.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - states_.begin());
  }
  /// The buffer to draw into: the one drawn but not committed, or a free one.
  /// kBusy: all of them are on their way or on screen.
  [[nodiscard]] rt::Result<std::uint32_t> tryBeginDraw() const {
    if (const auto drawn = find(BufferState::kDrawn)) return *drawn;
    if (const auto free = find(BufferState::kFree)) return *free;
    return std::unexpected(rt::Error{rt::Errc::kBusy, 0, "render: no buffer is free"});
  }

 private:
  std::vector<BufferState> states_;
};

}  // namespace ui
