#include "ui-kms/font_set.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <ft2build.h>
#include FT_FREETYPE_H

#include <hb-ft.h>
#include <hb.h>

namespace ui {
namespace {

constexpr std::array<const char*, 4> kLatin = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf",
};
constexpr std::array<const char*, 4> kJapanese = {
    "/usr/share/fonts/opentype/ipaexfont-gothic/ipaexg.ttf",
    "/usr/share/fonts/truetype/fonts-japanese-gothic.ttf",
    "/usr/share/fonts/opentype/noto/NotoSansCJK-Bold.ttc",
    "/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc",
};

constexpr char32_t kReplacement = 0xFFFD;

float from26Dot6(FT_Pos value) {
  return static_cast<float>(value) / 64.0F;
}

struct Letter {
  char32_t code = kReplacement;
  std::size_t bytes = 1;  // what is no utf-8 counts byte by byte
};

Letter letterAt(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || at + bytes > text.size()) return {};
  char32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  return {code, bytes};
}

/// Marks and joiners change the letter before them and are drawn from its font.
bool changesTheOneBefore(char32_t letter) {
  switch (hb_unicode_general_category(hb_unicode_funcs_get_default(), letter)) {
    case HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_FORMAT:
      return true;
    default:
      return false;
  }
}

}  // namespace

struct FontSet::Library {
  struct Face {
    FT_Face face = nullptr;
    hb_font_t* shaper = nullptr;
  };
  FT_Library freetype = nullptr;
  hb_buffer_t* buffer = nullptr;
  std::vector<Face> faces;
  std::uint32_t size_px = 0;

  ~Library() {
    hb_buffer_destroy(buffer);
    for (const Face& face : faces) {
      hb_font_destroy(face.shaper);
      FT_Done_Face(face.face);
    }
    FT_Done_FreeType(freetype);
  }

  bool tryOpen(const char* path) {
    Face opened;
    if (FT_New_Face(freetype, path, 0, &opened.face) != 0) return false;
    if (FT_Set_Pixel_Sizes(opened.face, 0, 16) != 0) {  // a font of fixed sizes
      FT_Done_Face(opened.face);
      return false;
    }
    opened.shaper = hb_ft_font_create_referenced(opened.face);
    hb_ft_font_set_load_flags(opened.shaper, FT_LOAD_DEFAULT | FT_LOAD_NO_BITMAP);
    faces.push_back(opened);
    return true;
  }
  bool tryOpenFirst(std::span<const char* const> paths) {
    return std::ranges::any_of(paths, [this](const char* path) { return tryOpen(path); });
  }
};

FontSet::FontSet(std::unique_ptr<Library> library) : library_(std::move(library)) {}
FontSet::~FontSet() = default;
FontSet::FontSet(FontSet&& other) noexcept = default;
FontSet& FontSet::operator=(FontSet&& other) noexcept = default;

std::expected<FontSet, std::string> FontSet::create(const std::string& font_path) {
  auto library = std::make_unique<Library>();
  if (FT_Init_FreeType(&library->freetype) != 0) return std::unexpected("FreeType does not start");
  library->buffer = hb_buffer_create();
  std::vector<const char*> paths(kLatin.begin(), kLatin.end());
  if (!font_path.empty()) paths = {font_path.c_str()};
  if (!library->tryOpenFirst(paths)) {
    std::string tried;
    for (const char* path : paths) tried += (tried.empty() ? "" : ", ") + std::string(path);
    return std::unexpected("no font for text on the screen (" + tried +
                           "): install fonts-dejavu-core or set the font's path");
  }
  (void)library->tryOpenFirst(kJapanese);
  return FontSet(std::move(library));
}

void FontSet::setSize(std::uint32_t size_px) {
  if (std::exchange(library_->size_px, size_px) == size_px) return;
  for (const Library::Face& face : library_->faces) {
    FT_Set_Pixel_Sizes(face.face, 0, size_px);
    hb_ft_font_changed(face.shaper);
  }
}

std::uint32_t FontSet::faceFor(char32_t letter) {
  const auto& faces = library_->faces;
  const auto has = [letter](const Library::Face& face) {
    return FT_Get_Char_Index(face.face, letter) != 0;
  };
  const auto found = std::ranges::find_if(faces, has);
  if (found != faces.end()) return static_cast<std::uint32_t>(found - faces.begin());
  const bool is_drawn = letter >= 0x20 && !changesTheOneBefore(letter);
  if (is_drawn && std::ranges::find(missing_, letter) == missing_.end()) {
    missing_.push_back(letter);
  }
  return 0;
}

bool FontSet::staysIn(std::uint32_t face, char32_t letter) {
  return changesTheOneBefore(letter) || faceFor(letter) == face;
}

void FontSet::shape(std::string_view text, std::uint32_t size_px, ShapedLine& line) {
  setSize(size_px);
  line.glyphs.clear();
  line.width_px = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const Letter first = letterAt(text, begin);
    const std::uint32_t face = faceFor(first.code);
    std::size_t end = begin + first.bytes;
    while (end < text.size()) {
      const Letter next = letterAt(text, end);
      if (!staysIn(face, next.code)) break;
      end += next.bytes;
    }
    shapeRun(text, begin, end, face, line);
    begin = end;
  }
}

void FontSet::shapeRun(std::string_view text, std::size_t begin, std::size_t end,
                       std::uint32_t face, ShapedLine& line) {
  hb_buffer_t* buffer = library_->buffer;
  hb_buffer_clear_contents(buffer);
  hb_buffer_add_utf8(buffer, text.data(), static_cast<int>(text.size()),
                     static_cast<unsigned>(begin), static_cast<int>(end - begin));
  hb_buffer_guess_segment_properties(buffer);
  hb_shape(library_->faces[face].shaper, buffer, nullptr, 0);
  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
  const hb_glyph_position_t* positions = hb_buffer_get_glyph_positions(buffer, &count);
  for (unsigned i = 0; i < count; ++i) {
    line.glyphs.push_back({.face = face,
                           .id = infos[i].codepoint,
                           .x_px = line.width_px + from26Dot6(positions[i].x_offset),
                           .y_px = -from26Dot6(positions[i].y_offset),
                           .at = infos[i].cluster});
    line.width_px += from26Dot6(positions[i].x_advance);
  }
}

GlyphBitmap FontSet::rasterise(std::uint32_t face, std::uint32_t id, std::uint32_t size_px) {
  setSize(size_px);
  FT_Face font = library_->faces[face].face;
  if (FT_Load_Glyph(font, id, FT_LOAD_RENDER | FT_LOAD_NO_BITMAP) != 0) return {};
  const FT_GlyphSlot slot = font->glyph;
  const FT_Bitmap& bitmap = slot->bitmap;
  if (bitmap.pixel_mode != FT_PIXEL_MODE_GRAY || bitmap.width == 0 || bitmap.rows == 0) return {};
  return {.rows = bitmap.buffer,
          .pitch = bitmap.pitch,
          .width_px = static_cast<std::uint16_t>(bitmap.width),
          .height_px = static_cast<std::uint16_t>(bitmap.rows),
          .left_px = slot->bitmap_left,
          .top_px = slot->bitmap_top};
}

float FontSet::capHeightPx(std::uint32_t size_px) {
  const GlyphBitmap capital =
      rasterise(0, FT_Get_Char_Index(library_->faces[0].face, 'H'), size_px);
  return capital.rows != nullptr ? static_cast<float>(capital.top_px)
                                 : 0.7F * static_cast<float>(size_px);
}

}  // namespace ui
