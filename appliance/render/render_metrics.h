#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/display.h"
#include "rt/counter.h"
#include "rt/duration_window.h"

namespace appliance {

/// What the render thread counts about itself.
///
/// Threads  The members' writers: the render thread. Their readers: any.
struct RenderMetrics {
  rt::Counter pictures;               ///< handed to the display
  rt::Counter sets_shown;             ///< of them, with another moment than the one before
  rt::Counter skipped;                ///< pictures that the display was not ready for
  rt::Counter flips;                  ///< pictures that came on screen
  rt::DurationWindow draw;            ///< from waking until a picture is drawn
  rt::DurationWindow ready_delay;     ///< from a live frame's trigger edge to its last packet
  rt::DurationWindow commit_to_flip;  ///< longer than usual: the picture missed its vblank

  void committed(std::uint64_t picture, rt::Timestamp commit) RT_SAFE {
    pictures.add();
    commits_[picture % commits_.size()] = {.picture = picture, .at = commit};
  }
  void flipped(const hal::PageFlip& flip) RT_SAFE {
    flips.add();
    const Commit& commit = commits_[flip.picture_id % commits_.size()];
    if (commit.picture == flip.picture_id) commit_to_flip.add(flip.page_flip - commit.at);
  }

 private:
  struct Commit {
    std::uint64_t picture = 0;
    rt::Timestamp at;
  };
  std::array<Commit, 16> commits_{};  // more than any display has under way
};

}  // namespace appliance
