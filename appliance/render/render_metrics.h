#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "rt/counter.h"
#include "rt/duration_window.h"

namespace appliance {

/// What the render thread counts about itself.
///
/// Threads  The members' writers: the render thread. Their readers: any.
struct RenderMetrics {
  rt::Counter pictures;     ///< handed to the display
  rt::Counter sets_shown;   ///< of them, with another moment than the one before
  rt::Counter skipped;      ///< pictures that the display was not ready for
  rt::Counter flips;        ///< pictures that came on screen
  rt::Counter flips_late;   ///< of them, a vblank or more after the one they were in time for
  rt::DurationWindow draw;  ///< from waking until a picture is drawn
  rt::DurationWindow ready_delay;     ///< from a live frame's trigger edge to its last packet
  rt::DurationWindow commit_to_flip;  ///< from a commit until its picture is on screen

  /// @p timing: the screen's vblanks at that time; none: not known, and no flip counts as late.
  void committed(std::uint64_t picture, rt::Timestamp commit,
                 const std::optional<hal::DisplayTiming>& timing) RT_SAFE {
    pictures.add();
    rt::Timestamp latest;
    if (timing) {
      const rt::Nanoseconds period(std::llround(timing->period_ns));
      const rt::Timestamp in_time_for =
          timing->vblankAt(timing->firstVblankAfter(commit + timing->commit_margin));
      // A picture behind another one comes with the vblank after that one's.
      vblank_ = std::max(in_time_for, vblank_ + period);
      latest = vblank_ + period / 2;
    }
    commits_[picture % commits_.size()] = {.picture = picture, .at = commit, .latest = latest};
  }
  void flipped(const hal::PageFlip& flip) RT_SAFE {
    flips.add();
    const Commit& commit = commits_[flip.picture_id % commits_.size()];
    if (commit.picture != flip.picture_id) return;
    commit_to_flip.add(flip.page_flip - commit.at);
    if (commit.latest != rt::Timestamp{} && flip.page_flip > commit.latest) flips_late.add();
  }

 private:
  struct Commit {
    std::uint64_t picture = 0;
    rt::Timestamp at;
    rt::Timestamp latest;  // a later flip is late; the epoch: not known
  };
  rt::Timestamp vblank_;              // that the last picture was in time for
  std::array<Commit, 16> commits_{};  // more than any display has under way
};

}  // namespace appliance
