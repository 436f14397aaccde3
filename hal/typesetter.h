#pragma once

#include <string>
#include <string_view>

#include "hal/overlay.h"

namespace hal {

/// Where a line of text begins, and how much room it has.
struct TextBox {
  float x_px = 0;
  float baseline_px = 0;
  float width_px = 0;
  float size_px = 0;  ///< of the type: from line to line
};

/// Turns text into the letters that a display draws.
///
/// Threads  One caller, which is not real-time; the display draws meanwhile on its own thread.
/// RT       Not safe: shaping and rasterising allocate.
class Typesetter {
 public:
  virtual ~Typesetter() = default;

  /// A new, empty overlay; finish() gives it its number. One at a time.
  virtual void begin(Overlay& overlay) = 0;
  virtual void finish(Overlay& overlay) = 0;

  /// Adds a line of utf-8; the width it took. A text longer than its box ends in an ellipsis behind
  /// its last whole letter that fits. A letter that no font has is a box.
  /// @pre between begin() and finish()
  virtual float set(Overlay& overlay, std::string_view text, const TextBox& box,
                    OverlayColour colour) = 0;
  [[nodiscard]] virtual float widthPx(std::string_view text, float size_px) = 0;
  /// Of a capital letter, for centring a line by the eye.
  [[nodiscard]] virtual float capHeightPx(float size_px) = 0;

  /// Once, when a letter was needed that no font has: which, and what to install. Empty otherwise.
  [[nodiscard]] virtual std::string takeWarning() = 0;
};

}  // namespace hal
