#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

#include "hal/typesetter.h"
#include "ui-kms/font_set.h"
#include "ui-kms/glyph_store.h"

namespace ui {

/// Lines of text as letters of a GlyphStore.
///
/// Threads  As hal::Typesetter.
/// Memory   Remembers where kMostRemembered letters stand.
class TextSetter final : public hal::Typesetter {
 public:
  /// @p store outlives this.
  TextSetter(FontSet fonts, GlyphStore& store) : fonts_(std::move(fonts)), store_(store) {}

  void begin(hal::Overlay& overlay) override;
  void finish(hal::Overlay& overlay) override;
  float set(hal::Overlay& overlay, std::string_view text, const hal::TextBox& box,
            hal::OverlayColour colour) override;
  [[nodiscard]] float widthPx(std::string_view text, float size_px) override;
  [[nodiscard]] float capHeightPx(float size_px) override;
  [[nodiscard]] std::string takeWarning() override;

 private:
  static constexpr std::size_t kMostRemembered = 4096;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // face, glyph, size
  struct Letter {
    GlyphStore::Place place;
    std::int32_t left_px = 0, top_px = 0;
    bool drawn = false;  // false: a space
  };

  void shorten(std::string_view text, std::uint32_t size_px, float room_px);
  [[nodiscard]] const Letter* letterFor(const ShapedGlyph& glyph, std::uint32_t size_px);

  FontSet fonts_;
  GlyphStore& store_;
  std::uint64_t generation_ = 0;
  std::map<Key, Letter> letters_;
  ShapedLine line_;
  bool warned_ = false;
};

}  // namespace ui
