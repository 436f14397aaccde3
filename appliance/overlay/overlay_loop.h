#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include "appliance/director/status_line.h"
#include "appliance/overlay/overlay_board.h"
#include "hal/typesetter.h"

namespace appliance {

/// Makes the overlay whenever what it is about has changed. So far it is the status line.
///
/// Threads  run(): the `ui` thread, which is not real-time. warning(): any other. On a busy box the
///          overlay lags behind the pictures; nothing waits for it.
class OverlayLoop {
 public:
  /// Both outlive this.
  OverlayLoop(OverlayBoard& board, hal::Typesetter& typesetter)
      : board_(board), typesetter_(typesetter), overlay_(std::make_unique<hal::Overlay>()) {}

  void run(const std::stop_token& stop);

  /// What text lacks on this machine, in one line; empty: nothing. Any thread.
  [[nodiscard]] std::string warning() const;

 private:
  void follow(const OverlaySubject& subject);

  OverlayBoard& board_;
  hal::Typesetter& typesetter_;
  std::unique_ptr<hal::Overlay> overlay_;
  mutable std::mutex warning_mutex_;
  std::string warning_;  // under that mutex
  // What the overlay on the board says, for a picture of what size.
  StatusText said_;
  std::uint32_t width_px_ = 0;
  std::uint32_t height_px_ = 0;
};

}  // namespace appliance
