#include "ui-kms/glyph_store.h"

#include <algorithm>
#include <cstring>

namespace ui {
namespace {

constexpr std::uint32_t kGapPx = 1;

}  // namespace

/// True if the page's next place fits that letter.
bool GlyphStore::makeRoom(Page& page, std::uint32_t width_px, std::uint32_t height_px) {
  if (page.x_px + width_px + kGapPx > kPagePx) {  // a new row
    page.x_px = 0;
    page.y_px += page.row_px + kGapPx;
    page.row_px = 0;
  }
  return page.y_px + height_px + kGapPx <= kPagePx;
}

GlyphStore::Page* GlyphStore::pageFor(std::uint32_t width_px, std::uint32_t height_px) {
  for (std::uint32_t i = 0; i < made_; ++i) {
    if (makeRoom(pages_[i], width_px, height_px)) return &pages_[i];
  }
  if (made_ < kMostPages) {
    pages_[made_].pixels.resize(std::size_t{kPagePx} * kPagePx);
    return &pages_[made_++];
  }
  Page& oldest = *std::ranges::min_element(pages_, {}, &Page::last_use);
  const bool drawn = oldest.last_use >= adopted_.load(std::memory_order_acquire);
  if (drawn || oldest.last_use == generation_) return nullptr;
  ++oldest.filling;
  oldest.x_px = oldest.y_px = oldest.row_px = 0;
  std::ranges::fill(oldest.pixels, std::uint8_t{0});
  return &oldest;
}

std::optional<GlyphStore::Place> GlyphStore::put(std::uint16_t width_px, std::uint16_t height_px,
                                                 const std::uint8_t* rows, std::ptrdiff_t pitch) {
  if (width_px + kGapPx > kPagePx || height_px + kGapPx > kPagePx) return std::nullopt;
  Page* const page = pageFor(width_px, height_px);
  if (page == nullptr) return std::nullopt;
  const Place place{.page = static_cast<std::uint8_t>(page - pages_.data()),
                    .u_px = static_cast<std::uint16_t>(page->x_px),
                    .v_px = static_cast<std::uint16_t>(page->y_px),
                    .width_px = width_px,
                    .height_px = height_px,
                    .filling = page->filling};
  for (std::uint32_t row = 0; row < height_px; ++row) {
    std::memcpy(&page->pixels[std::size_t{kPagePx} * (page->y_px + row) + page->x_px],
                rows + static_cast<std::ptrdiff_t>(row) * pitch, width_px);
  }
  if (!uploads_.tryPush(place)) return std::nullopt;
  ++letters_;
  page->last_use = generation_;
  page->x_px += width_px + kGapPx;
  page->row_px = std::max<std::uint32_t>(page->row_px, height_px);
  return place;
}

bool GlyphStore::use(const Place& place) {
  if (!holds(place)) return false;
  pages_[place.page].last_use = generation_;
  return true;
}

}  // namespace ui
