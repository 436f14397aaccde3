#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/display.h"
#include "rt/clock.h"
#include "rt/result.h"
#include "ui-kms/flip_grid.h"

namespace ui {

/// What a buffer is for, and who moves it there: render() draws a free one, commit() makes it
/// pending, the vblank puts it on screen and frees the one before. Queued: committed, but one
/// before it is pending still.
enum class BufferState : std::uint8_t { kFree, kDrawn, kQueued, kPending, kOnScreen };

/// The life of the buffers of one screen. Pure: time is an argument, and what happened at vblanks
/// in between is worked out when the next call asks.
///
/// Memory   Storage is made by the constructor. Flips that nobody takes are kept up to
///          kFlipsKept; then the oldest is overwritten and counted.
class SwapChain {
 public:
  static constexpr std::size_t kFlipsKept = 64;

  SwapChain(std::uint32_t buffers, FlipGrid grid);

  /// The buffer to draw into: the one drawn but not committed, or a free one.
  /// kBusy: every buffer is pending or on screen.
  [[nodiscard]] rt::Result<std::uint32_t> tryBeginDraw(rt::Timestamp now);
  void finishDraw(std::uint32_t buffer);

  /// kBusy: the last commit has not flipped yet; the drawn buffer stays drawn.
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t picture_id, rt::Timestamp now);

  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip(rt::Timestamp now);

  [[nodiscard]] BufferState state(std::uint32_t buffer) const { return states_[buffer]; }
  /// The drawn buffer, which waits for its commit.
  [[nodiscard]] std::optional<std::uint32_t> drawn() const { return find(BufferState::kDrawn); }
  [[nodiscard]] bool pending() const { return find(BufferState::kPending).has_value(); }
  /// The buffer committed last, if any.
  [[nodiscard]] std::optional<std::uint32_t> committed() const { return committed_; }
  /// When it came or will come on screen.
  [[nodiscard]] std::optional<hal::PageFlip> committedFlip() const { return committed_flip_; }
  [[nodiscard]] std::uint64_t flipsOverwritten() const { return flips_overwritten_; }

 private:
  void advance(rt::Timestamp now);
  [[nodiscard]] std::optional<std::uint32_t> find(BufferState wanted) const;

  FlipGrid grid_;
  std::vector<BufferState> states_;
  std::optional<std::uint32_t> committed_;
  std::optional<hal::PageFlip> committed_flip_;
  std::array<hal::PageFlip, kFlipsKept> flips_{};
  std::size_t first_flip_ = 0;
  std::size_t flip_count_ = 0;
  std::uint64_t flips_overwritten_ = 0;
};

}  // namespace ui
