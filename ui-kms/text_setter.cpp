#include "ui-kms/text_setter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace ui {
namespace {

constexpr std::string_view kEllipsis = "\u2026";

std::uint32_t wholePx(float size_px) {
  return static_cast<std::uint32_t>(std::clamp(std::lround(size_px), 4L, 512L));
}

void appendUtf8(std::string& text, char32_t letter) {
  const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (letter < 0x80) {
    put(letter);
  } else if (letter < 0x800) {
    put(0xC0U | letter >> 6U);
    put(0x80U | (letter & 0x3FU));
  } else if (letter < 0x10000) {
    put(0xE0U | letter >> 12U);
    put(0x80U | (letter >> 6U & 0x3FU));
    put(0x80U | (letter & 0x3FU));
  } else {
    put(0xF0U | letter >> 18U);
    put(0x80U | (letter >> 12U & 0x3FU));
    put(0x80U | (letter >> 6U & 0x3FU));
    put(0x80U | (letter & 0x3FU));
  }
}

}  // namespace

void TextSetter::begin(hal::Overlay& overlay) {
  store_.begin(++generation_);
  overlay.count = 0;
  overlay.refused = 0;
}

void TextSetter::finish(hal::Overlay& overlay) {
  overlay.generation = generation_;
  overlay.glyphs = store_.letters();
}

float TextSetter::set(hal::Overlay& overlay, std::string_view text, const hal::TextBox& box,
                      hal::OverlayColour colour) {
  const std::uint32_t size_px = wholePx(box.size_px);
  fonts_.shape(text, size_px, line_);
  if (line_.width_px > box.width_px) shorten(text, size_px, box.width_px);
  for (const ShapedGlyph& glyph : line_.glyphs) {
    const Letter* letter = letterFor(glyph, size_px);
    if (letter == nullptr) {
      ++overlay.refused;
      continue;
    }
    if (!letter->drawn) continue;
    // At whole pixels each pixel of the letter is one of the picture.
    const float x_px = std::round(box.x_px + glyph.x_px) + static_cast<float>(letter->left_px);
    const float y_px =
        std::round(box.baseline_px + glyph.y_px) - static_cast<float>(letter->top_px);
    overlay.add({.kind = hal::OverlayItem::Kind::kGlyph,
                 .page = letter->place.page,
                 .u_px = letter->place.u_px,
                 .v_px = letter->place.v_px,
                 .colour = colour,
                 .x_px = x_px,
                 .y_px = y_px,
                 .width_px = static_cast<float>(letter->place.width_px),
                 .height_px = static_cast<float>(letter->place.height_px)});
  }
  return line_.width_px;
}

float TextSetter::widthPx(std::string_view text, float size_px) {
  fonts_.shape(text, wholePx(size_px), line_);
  return line_.width_px;
}

float TextSetter::capHeightPx(float size_px) {
  return fonts_.capHeightPx(wholePx(size_px));
}

/// Leaves in line_ the longest beginning of the text that fits with an ellipsis behind it; nothing
/// where not even that one fits.
void TextSetter::shorten(std::string_view text, std::uint32_t size_px, float room_px) {
  struct Border {
    std::uint32_t at;  // byte of the text
    float width_px;    // of what comes before
  };
  std::vector<Border> borders;  // HarfBuzz never divides a letter and its marks
  for (const ShapedGlyph& glyph : line_.glyphs) {
    if (borders.empty() || glyph.at > borders.back().at) borders.push_back({glyph.at, glyph.x_px});
  }
  fonts_.shape(kEllipsis, size_px, line_);
  const float ellipsis_px = line_.width_px;
  std::string shortened;
  while (!borders.empty()) {
    const Border border = borders.back();
    borders.pop_back();
    if (border.width_px + ellipsis_px > room_px) continue;
    shortened = text.substr(0, border.at);
    while (shortened.ends_with(' ')) shortened.pop_back();
    shortened += kEllipsis;
    fonts_.shape(shortened, size_px, line_);
    if (line_.width_px <= room_px) return;
  }
  line_ = {};
}

const TextSetter::Letter* TextSetter::letterFor(const ShapedGlyph& glyph, std::uint32_t size_px) {
  const Key key{glyph.face, glyph.id, size_px};
  const auto known = letters_.find(key);
  if (known != letters_.end()) {
    if (!known->second.drawn || store_.use(known->second.place)) return &known->second;
    letters_.erase(known);
  }
  if (letters_.size() >= kMostRemembered) {
    std::erase_if(letters_, [this](const auto& entry) {
      return entry.second.drawn && !store_.holds(entry.second.place);
    });
  }
  const GlyphBitmap bitmap = fonts_.rasterise(glyph.face, glyph.id, size_px);
  Letter letter{.left_px = bitmap.left_px, .top_px = bitmap.top_px};
  if (bitmap.rows != nullptr) {
    const auto place = store_.put(bitmap.width_px, bitmap.height_px, bitmap.rows, bitmap.pitch);
    if (!place) return nullptr;
    letter.place = *place;
    letter.drawn = true;
  }
  return &letters_.emplace(key, letter).first->second;
}

std::string TextSetter::takeWarning() {
  if (warned_ || fonts_.missing().empty()) return {};
  warned_ = true;
  constexpr std::size_t kMostNamed = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(fonts_.missing().size(), kMostNamed); ++i) {
    const char32_t letter = fonts_.missing()[i];
    char code[16];
    (void)std::snprintf(code, sizeof code, " (U+%04X)", static_cast<unsigned>(letter));
    if (!names.empty()) names += ", ";
    appendUtf8(names, letter);
    names += code;
  }
  return "no installed font has " + names +
         ": such letters are boxes on the screen; for Japanese install fonts-ipaexfont-gothic";
}

}  // namespace ui
