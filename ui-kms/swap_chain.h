#pragma once

#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "rt/clock.h"
#include "rt/result.h"
#include "ui-kms/buffer_states.h"
#include "ui-kms/flip_grid.h"
#include "ui-kms/flip_list.h"

namespace ui {

/// The life of the buffers of one screen. Pure: time is an argument, and what happened at vblanks
/// in between is worked out when the next call asks.
///
/// Memory   Storage is made by the constructor. Flips that the caller has not taken stay in a
/// FlipList.
class SwapChain {
 public:
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
  [[nodiscard]] std::optional<std::uint32_t> drawn() const {
    return states_.find(BufferState::kDrawn);
  }
  [[nodiscard]] bool pending() const { return states_.find(BufferState::kPending).has_value(); }
  /// The buffer committed last, if any.
  [[nodiscard]] std::optional<std::uint32_t> committed() const { return committed_; }
  /// When it came or will come on screen.
  [[nodiscard]] std::optional<hal::PageFlip> committedFlip() const { return committed_flip_; }

 private:
  void advance(rt::Timestamp now);

  FlipGrid grid_;
  BufferStates states_;
  std::optional<std::uint32_t> committed_;
  std::optional<hal::PageFlip> committed_flip_;
  FlipList flips_;
};

}  // namespace ui
