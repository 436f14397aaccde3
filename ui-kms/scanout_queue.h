#pragma once

#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "rt/clock.h"
#include "rt/result.h"
#include "ui-kms/buffer_states.h"
#include "ui-kms/flip_list.h"

namespace ui {

/// The life of the buffers of a screen whose flips are events. render() draws a free one, commit()
/// makes it pending, the flip event puts it on screen and frees the one before. With a depth of 2 a
/// picture may be committed while another is pending: it is queued here, and goes to the kernel
/// when that one's flip is reported. It is then up to one vblank older when it comes on screen.
///
/// Memory   Storage is made by the constructor. Flips that the caller has not taken stay in a
/// FlipList.
class ScanoutQueue {
 public:
  /// @p depth: 1 or 2, pictures on their way to the screen.
  explicit ScanoutQueue(std::uint32_t depth) : depth_(depth), states_(depth + 2) {}

  [[nodiscard]] std::uint32_t buffers() const { return states_.size(); }
  [[nodiscard]] BufferState state(std::uint32_t buffer) const { return states_[buffer]; }

  /// The buffer to draw into: the one drawn but not committed, or a free one.
  /// kBusy: all of them are on their way or on screen.
  [[nodiscard]] rt::Result<std::uint32_t> tryBeginDraw() const { return states_.tryBeginDraw(); }
  void finishDraw(std::uint32_t buffer);

  /// The drawn buffer, which waits for its commit.
  [[nodiscard]] std::optional<std::uint32_t> drawn() const {
    return states_.find(BufferState::kDrawn);
  }
  [[nodiscard]] bool pending() const { return states_.find(BufferState::kPending).has_value(); }
  [[nodiscard]] bool queued() const { return states_.find(BufferState::kQueued).has_value(); }
  /// Whether a commit would be taken now.
  [[nodiscard]] bool takesCommit() const;

  /// A picture behind the pending one.
  void queue(std::uint32_t buffer, std::uint64_t picture_id);
  /// The queued picture that may be submitted now: nothing is pending any more.
  struct Due {
    std::uint32_t buffer;
    std::uint64_t picture_id;
  };
  [[nodiscard]] std::optional<Due> due() const;

  /// The kernel took it; its flip will carry @p serial.
  void submitted(std::uint32_t buffer, std::uint64_t picture_id, std::uint64_t serial);
  /// The buffer whose flip that is; none for a flip from before a dropAll().
  [[nodiscard]] std::optional<std::uint32_t> pendingBuffer(std::uint64_t serial) const;
  /// That buffer came on screen.
  void onFlip(std::uint64_t serial, std::uint64_t vblank, rt::Timestamp at);
  /// Nothing is on its way or on screen any more, and nothing drawn.
  void dropAll();

  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip();

  /// The buffer committed last, if any.
  [[nodiscard]] std::optional<std::uint32_t> committed() const { return committed_; }
  /// Its flip, if it was reported already.
  [[nodiscard]] std::optional<hal::PageFlip> committedFlip() const { return committed_flip_; }

 private:
  void commit(std::uint32_t buffer);

  std::uint32_t depth_;
  BufferStates states_;
  std::uint64_t pending_serial_ = 0;
  std::uint64_t pending_picture_ = 0;
  std::uint64_t queued_picture_ = 0;
  std::optional<std::uint32_t> committed_;
  std::optional<hal::PageFlip> committed_flip_;
  FlipList flips_;
};

}  // namespace ui
