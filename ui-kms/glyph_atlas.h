#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ui {

/// One glyph's place on a line and in the atlas, in pixels; y goes down, 0 is the baseline.
struct PlacedGlyph {
  float x_px, y_px, width_px, height_px;
  std::uint16_t atlas_x, atlas_y;
};

/// All glyphs a status line may need, rasterised once by FreeType and laid out by HarfBuzz.
///
/// Threads  One caller at a time.
/// Memory   shape() allocates inside HarfBuzz; call it when the text changes, not per picture.
/// Errors   create(): one line with the paths that were tried.
class GlyphAtlas {
 public:
  /// @p font_path empty: the usual places of DejaVu Sans. @p em_px: the type size.
  [[nodiscard]] static std::expected<GlyphAtlas, std::string> create(const std::string& font_path,
                                                                     std::uint32_t em_px);
  ~GlyphAtlas();
  GlyphAtlas(GlyphAtlas&& other) noexcept;
  GlyphAtlas& operator=(GlyphAtlas&& other) noexcept;

  /// Lays out @p text (utf-8) from x = 0 into @p line and returns the line's width in pixels.
  /// Letters outside the atlas come out as the font's box for missing glyphs.
  float shape(std::string_view text, std::vector<PlacedGlyph>& line);

  /// One byte of coverage per pixel.
  [[nodiscard]] std::span<const std::uint8_t> pixels() const { return pixels_; }
  [[nodiscard]] std::uint32_t widthPx() const { return width_px_; }
  [[nodiscard]] std::uint32_t heightPx() const { return height_px_; }
  /// Of a capital letter, for centring a line by the eye.
  [[nodiscard]] float capHeightPx() const { return cap_height_px_; }

 private:
  struct Font;  // FreeType and HarfBuzz stay out of this header
  struct Glyph {
    std::uint32_t id = 0;
    std::uint16_t atlas_x = 0, atlas_y = 0, width_px = 0, height_px = 0;
    std::int16_t left_px = 0, top_px = 0;
  };
  explicit GlyphAtlas(std::unique_ptr<Font> font);
  void rasterise(std::uint32_t em_px);
  [[nodiscard]] const Glyph* find(std::uint32_t id) const;

  std::unique_ptr<Font> font_;
  std::vector<Glyph> glyphs_;  // ordered by id
  std::vector<std::uint8_t> pixels_;
  std::uint32_t width_px_ = 0;
  std::uint32_t height_px_ = 0;
  float cap_height_px_ = 0;
};

}  // namespace ui
