#include "ui-kms/glyph_atlas.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <utility>

#include <ft2build.h>
#include FT_FREETYPE_H

#include <hb-ft.h>
#include <hb.h>

namespace ui {
namespace {

constexpr std::array<const char*, 4> kUsualFonts = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf",
};

struct Range {
  std::uint32_t first, last;
};
/// Latin with its accents, dashes and dots, arrows, and the marks of playback.
constexpr std::array<Range, 8> kRanges = {{{0x20, 0x7e},
                                           {0xa0, 0x17f},
                                           {0x2010, 0x2026},
                                           {0x2030, 0x203a},
                                           {0x2190, 0x2195},
                                           {0x2212, 0x2212},
                                           {0x25a0, 0x25cf},
                                           {0x26a0, 0x26a0}}};

constexpr std::uint32_t kAtlasWidthPx = 1024;
constexpr std::uint32_t kGapPx = 2;  // the neighbour must not bleed into a scaled glyph

float from26Dot6(hb_position_t value) {
  return static_cast<float>(value) / 64.0F;
}

}  // namespace

struct GlyphAtlas::Font {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  hb_font_t* shaper = nullptr;
  hb_buffer_t* buffer = nullptr;

  ~Font() {
    hb_buffer_destroy(buffer);
    hb_font_destroy(shaper);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
};

GlyphAtlas::GlyphAtlas(std::unique_ptr<Font> font) : font_(std::move(font)) {}
GlyphAtlas::~GlyphAtlas() = default;
GlyphAtlas::GlyphAtlas(GlyphAtlas&& other) noexcept = default;
GlyphAtlas& GlyphAtlas::operator=(GlyphAtlas&& other) noexcept = default;

std::expected<GlyphAtlas, std::string> GlyphAtlas::create(const std::string& font_path,
                                                          std::uint32_t em_px) {
  auto font = std::make_unique<Font>();
  if (FT_Init_FreeType(&font->library) != 0) return std::unexpected("FreeType does not start");
  std::vector<std::string> paths(kUsualFonts.begin(), kUsualFonts.end());
  if (!font_path.empty()) paths = {font_path};
  std::string tried;
  for (const std::string& path : paths) {
    if (FT_New_Face(font->library, path.c_str(), 0, &font->face) == 0) break;
    font->face = nullptr;
    tried += (tried.empty() ? "" : ", ") + path;
  }
  if (font->face == nullptr || FT_Set_Pixel_Sizes(font->face, 0, em_px) != 0) {
    return std::unexpected("no font for the status line (" + (tried.empty() ? paths[0] : tried) +
                           "): install fonts-dejavu-core or set the font's path");
  }
  font->shaper = hb_ft_font_create_referenced(font->face);
  hb_ft_font_set_load_flags(font->shaper, FT_LOAD_DEFAULT);
  font->buffer = hb_buffer_create();
  GlyphAtlas atlas(std::move(font));
  atlas.rasterise(em_px);
  return atlas;
}

void GlyphAtlas::rasterise(std::uint32_t em_px) {
  FT_Face face = font_->face;
  std::vector<std::uint32_t> ids = {0};  // the box for missing glyphs
  for (const Range& range : kRanges) {
    for (std::uint32_t letter = range.first; letter <= range.last; ++letter) {
      ids.push_back(FT_Get_Char_Index(face, letter));
    }
  }
  std::ranges::sort(ids);
  const auto repeated = std::ranges::unique(ids);
  ids.erase(repeated.begin(), repeated.end());

  width_px_ = kAtlasWidthPx;
  std::uint32_t x = kGapPx;
  std::uint32_t y = kGapPx;
  std::uint32_t shelf = 0;
  for (const std::uint32_t id : ids) {
    if (FT_Load_Glyph(face, id, FT_LOAD_RENDER) != 0) continue;
    const FT_GlyphSlot slot = face->glyph;
    const FT_Bitmap& bitmap = slot->bitmap;
    if (bitmap.pixel_mode != FT_PIXEL_MODE_GRAY && bitmap.rows != 0) continue;
    if (bitmap.width + 2 * kGapPx > width_px_) continue;
    if (x + bitmap.width + kGapPx > width_px_) {
      x = kGapPx;
      y += shelf + kGapPx;
      shelf = 0;
    }
    shelf = std::max(shelf, bitmap.rows);
    pixels_.resize(std::size_t{width_px_} * (y + shelf + kGapPx));
    for (std::uint32_t row = 0; row < bitmap.rows; ++row) {
      std::memcpy(&pixels_[std::size_t{width_px_} * (y + row) + x],
                  bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch, bitmap.width);
    }
    glyphs_.push_back({.id = id,
                       .atlas_x = static_cast<std::uint16_t>(x),
                       .atlas_y = static_cast<std::uint16_t>(y),
                       .width_px = static_cast<std::uint16_t>(bitmap.width),
                       .height_px = static_cast<std::uint16_t>(bitmap.rows),
                       .left_px = static_cast<std::int16_t>(slot->bitmap_left),
                       .top_px = static_cast<std::int16_t>(slot->bitmap_top)});
    x += bitmap.width + kGapPx;
  }
  height_px_ = static_cast<std::uint32_t>(pixels_.size() / width_px_);
  const Glyph* capital = find(FT_Get_Char_Index(face, 'H'));
  cap_height_px_ = capital != nullptr ? static_cast<float>(capital->height_px)
                                      : 0.7F * static_cast<float>(em_px);
}

const GlyphAtlas::Glyph* GlyphAtlas::find(std::uint32_t id) const {
  const auto found = std::ranges::lower_bound(glyphs_, id, {}, &Glyph::id);
  return found != glyphs_.end() && found->id == id ? &*found : nullptr;
}

float GlyphAtlas::shape(std::string_view text, std::vector<PlacedGlyph>& line) {
  // Ligatures have glyphs of their own, which a set made from single letters does not hold.
  constexpr std::array<hb_feature_t, 2> kPlain = {
      {{HB_TAG('l', 'i', 'g', 'a'), 0, HB_FEATURE_GLOBAL_START, HB_FEATURE_GLOBAL_END},
       {HB_TAG('c', 'l', 'i', 'g'), 0, HB_FEATURE_GLOBAL_START, HB_FEATURE_GLOBAL_END}}};
  hb_buffer_t* buffer = font_->buffer;
  hb_buffer_clear_contents(buffer);
  hb_buffer_add_utf8(buffer, text.data(), static_cast<int>(text.size()), 0, -1);
  hb_buffer_guess_segment_properties(buffer);
  hb_shape(font_->shaper, buffer, kPlain.data(), kPlain.size());
  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
  const hb_glyph_position_t* positions = hb_buffer_get_glyph_positions(buffer, &count);
  line.clear();
  float pen_px = 0;
  for (unsigned i = 0; i < count; ++i) {
    const Glyph* glyph = find(infos[i].codepoint);
    if (glyph == nullptr) glyph = find(0);
    if (glyph != nullptr && glyph->width_px != 0) {
      line.push_back(
          {.x_px = pen_px + from26Dot6(positions[i].x_offset) + static_cast<float>(glyph->left_px),
           .y_px = -from26Dot6(positions[i].y_offset) - static_cast<float>(glyph->top_px),
           .width_px = static_cast<float>(glyph->width_px),
           .height_px = static_cast<float>(glyph->height_px),
           .atlas_x = glyph->atlas_x,
           .atlas_y = glyph->atlas_y});
    }
    pen_px += from26Dot6(positions[i].x_advance);
  }
  return pen_px;
}

}  // namespace ui
