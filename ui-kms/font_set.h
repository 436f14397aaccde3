#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ui {

/// One letter of a line, without its pixels.
struct ShapedGlyph {
  std::uint32_t face = 0;
  std::uint32_t id = 0;      ///< in that face
  float x_px = 0, y_px = 0;  ///< of its origin; 0,0 is the line's beginning on the baseline
  std::uint32_t at = 0;      ///< byte of the text that it begins with
};

struct ShapedLine {
  std::vector<ShapedGlyph> glyphs;
  float width_px = 0;
};

/// The coverage of one glyph, 0 to 255; it holds until the next call.
struct GlyphBitmap {
  const std::uint8_t* rows = nullptr;
  std::ptrdiff_t pitch = 0;
  std::uint16_t width_px = 0, height_px = 0;
  std::int32_t left_px = 0, top_px = 0;  ///< from its origin to the right, and up
};

/// Several fonts as one: each letter comes from the first that has it. FreeType and HarfBuzz.
///
/// Threads  One caller at a time.
/// Memory   Allocates inside FreeType and HarfBuzz.
/// Errors   create(): one line with the paths that were tried.
class FontSet {
 public:
  /// @p font_path empty: the usual places of DejaVu Sans. A Japanese font stands behind it where
  /// one is installed.
  [[nodiscard]] static std::expected<FontSet, std::string> create(const std::string& font_path);
  ~FontSet();
  FontSet(FontSet&& other) noexcept;
  FontSet& operator=(FontSet&& other) noexcept;

  /// Lays out one line of utf-8 from left to right. A letter that no font has becomes the first
  /// one's box.
  void shape(std::string_view text, std::uint32_t size_px, ShapedLine& line);
  /// None where the glyph has no pixels: a space.
  [[nodiscard]] GlyphBitmap rasterise(std::uint32_t face, std::uint32_t id, std::uint32_t size_px);
  /// Of a capital letter of the first font.
  [[nodiscard]] float capHeightPx(std::uint32_t size_px);

  /// Letters that no font had so far, each once.
  [[nodiscard]] const std::vector<char32_t>& missing() const { return missing_; }

 private:
  struct Library;  // FreeType and HarfBuzz stay out of this header
  explicit FontSet(std::unique_ptr<Library> library);
  void setSize(std::uint32_t size_px);
  [[nodiscard]] std::uint32_t faceFor(char32_t letter);
  [[nodiscard]] bool staysIn(std::uint32_t face, char32_t letter);
  void shapeRun(std::string_view text, std::size_t begin, std::size_t end, std::uint32_t face,
                ShapedLine& line);

  std::unique_ptr<Library> library_;
  std::vector<char32_t> missing_;
};

}  // namespace ui
