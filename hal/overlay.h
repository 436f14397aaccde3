#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace hal {

/// sRGB and opacity, 0 to 255.
struct OverlayColour {
  std::uint8_t red = 255, green = 255, blue = 255, alpha = 255;
};

/// One letter or mark over the picture, in pixels of the upright picture, y down.
struct OverlayItem {
  enum class Kind : std::uint8_t {
    kGlyph,  ///< a letter, in its own size, at whole pixels
    kPlate,  ///< a filled rectangle with round corners
    kRing,   ///< its outline; with corners of half its size: a circle
    kLine,   ///< from the box's first corner to its last
  };
  Kind kind = Kind::kPlate;
  std::uint8_t page = 0;  ///< of the glyph store; glyphs only, as the next two
  std::uint16_t u_px = 0, v_px = 0;
  OverlayColour colour;
  float x_px = 0, y_px = 0, width_px = 0, height_px = 0;
  float radius_px = 0;  ///< of the corners
  float stroke_px = 1;  ///< of rings and lines; of plates: how soft the rim is
};

/// What is drawn over the views, in this order: a value that one thread makes and another draws.
struct Overlay {
  static constexpr std::uint32_t kMostItems = 1024;
  std::array<OverlayItem, kMostItems> items{};
  std::uint32_t count = 0;
  std::uint32_t refused = 0;  ///< items that had no room here, letters that had none in the store
  std::uint64_t generation = 0;  ///< another number: another overlay; 0: the empty one
  std::uint64_t glyphs = 0;      ///< of the store, which must be uploaded before this is drawn

  void add(const OverlayItem& item) {
    if (count < kMostItems) {
      items[count++] = item;
    } else {
      ++refused;
    }
  }
};
static_assert(std::is_trivially_copyable_v<Overlay>, "crosses threads");

/// Two lines that meet at right angles.
inline void addCross(Overlay& overlay, float x_px, float y_px, float size_px, float stroke_px,
                     OverlayColour colour) {
  OverlayItem line{.kind = OverlayItem::Kind::kLine, .colour = colour, .stroke_px = stroke_px};
  line.x_px = x_px - size_px / 2;
  line.y_px = y_px;
  line.width_px = size_px;
  overlay.add(line);
  line.x_px = x_px;
  line.y_px = y_px - size_px / 2;
  line.width_px = 0;
  line.height_px = size_px;
  overlay.add(line);
}

}  // namespace hal
