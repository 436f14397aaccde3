#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "hal/display.h"
#include "rt/result.h"

namespace ui {

/// A display whose last committed picture can be read back, for the recorder and for tests.
///
/// Threads  The render thread.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// The last committed picture: RGBA bytes, top row first, 4 * width * height of the mode.
  /// Whole and unreduced: under a software renderer that is a copy, and cheaper than a reduction.
  [[nodiscard]] virtual rt::Result<void> readPicture(std::span<std::byte> rgba) = 0;

  /// When that picture comes or came on screen, where the display knows it already.
  [[nodiscard]] virtual std::optional<hal::PageFlip> committedFlip() const = 0;
};

}  // namespace ui
