#pragma once

#include <cstddef>
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

  /// Storage for readSmall(), before the render thread starts.
  virtual void prepareSmall(std::uint32_t width_px, std::uint32_t height_px) = 0;

  /// The last committed picture: RGBA bytes, top row first, 4 * width * height of the mode.
  [[nodiscard]] virtual rt::Result<void> readPicture(std::span<std::byte> rgba) = 0;

  /// The same, reduced to the size given to prepareSmall().
  [[nodiscard]] virtual rt::Result<void> readSmall(std::span<std::byte> rgba) = 0;

  /// When that picture comes or came on screen.
  [[nodiscard]] virtual std::optional<hal::PageFlip> committedFlip() const = 0;
};

}  // namespace ui
