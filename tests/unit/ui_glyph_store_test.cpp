#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "ui-kms/glyph_store.h"

namespace {

using ui::GlyphStore;

constexpr std::uint16_t kLarge = GlyphStore::kPagePx / 2 - 1;  // four of them fill a page

/// A letter of that many pixels each way, all of one coverage.
std::optional<GlyphStore::Place> put(GlyphStore& store, std::uint16_t size_px,
                                     std::uint8_t coverage = 1) {
  const std::vector<std::uint8_t> rows(std::size_t{size_px} * size_px, coverage);
  return store.put(size_px, size_px, rows.data(), size_px);
}

void uploadAll(GlyphStore& store) {
  while (store.tryPopUpload()) {
  }
}

/// Fills all pages, each in an overlay of its own; the letters of the first page.
std::vector<GlyphStore::Place> fill(GlyphStore& store) {
  std::vector<GlyphStore::Place> of_first;
  for (std::uint32_t page = 0; page < GlyphStore::kMostPages; ++page) {
    store.begin(page + 1);
    for (int letter = 0; letter < 4; ++letter) {
      const auto place = put(store, kLarge);
      EXPECT_TRUE(place);
      EXPECT_EQ(place->page, page);
      if (page == 0) of_first.push_back(*place);
    }
  }
  uploadAll(store);
  return of_first;
}

TEST(GlyphStore, LettersDoNotOverlapAndAreKeptAsTheyAre) {
  GlyphStore store;
  store.begin(1);
  const auto a = put(store, 30, 10);
  const auto b = put(store, 50, 20);
  ASSERT_TRUE(a && b);
  EXPECT_GE(b->u_px, a->u_px + 30);
  const auto pixels = store.pixels(0);
  const auto at = [&](const GlyphStore::Place& place, std::uint32_t x, std::uint32_t y) {
    return pixels[std::size_t{GlyphStore::kPagePx} * (place.v_px + y) + place.u_px + x];
  };
  EXPECT_EQ(at(*a, 29, 29), 10);
  EXPECT_EQ(at(*a, 30, 29), 0);
  EXPECT_EQ(at(*b, 49, 49), 20);
}

TEST(GlyphStore, EveryLetterIsUploadedOnceInOrder) {
  GlyphStore store;
  store.begin(1);
  (void)put(store, 8);
  (void)put(store, 9);
  EXPECT_EQ(store.letters(), 2U);
  EXPECT_EQ(store.tryPopUpload()->width_px, 8);
  EXPECT_EQ(store.tryPopUpload()->width_px, 9);
  EXPECT_FALSE(store.tryPopUpload());
}

TEST(GlyphStore, RefusesWhatIsLargerThanAPage) {
  GlyphStore store;
  store.begin(1);
  EXPECT_FALSE(store.put(GlyphStore::kPagePx, 8, nullptr, 0));
  EXPECT_FALSE(store.put(8, GlyphStore::kPagePx, nullptr, 0));
}

TEST(GlyphStore, RefusesMoreLettersThanWaitForTheirUpload) {
  GlyphStore store;
  store.begin(1);
  int letters = 0;
  while (put(store, 4)) ++letters;
  EXPECT_EQ(letters, 512);
  uploadAll(store);
  EXPECT_TRUE(put(store, 4));
}

TEST(GlyphStore, EmptiesThePageThatWasNotUsedForLongest) {
  GlyphStore store;
  const auto first = fill(store);
  store.adopt(GlyphStore::kMostPages);
  store.begin(GlyphStore::kMostPages + 1);
  const auto place = put(store, kLarge);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->page, 0);
  EXPECT_FALSE(store.holds(first[0]));
  EXPECT_FALSE(store.use(first[0]));
  EXPECT_TRUE(store.use(*place));
}

TEST(GlyphStore, APageThatIsStillUsedStays) {
  GlyphStore store;
  const auto first = fill(store);
  store.begin(GlyphStore::kMostPages + 1);
  EXPECT_TRUE(store.use(first[0]));
  store.adopt(GlyphStore::kMostPages + 1);
  store.begin(GlyphStore::kMostPages + 2);
  const auto place = put(store, kLarge);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->page, 1);
  EXPECT_TRUE(store.holds(first[0]));
}

TEST(GlyphStore, NoPageIsEmptiedThatMayStillBeDrawn) {
  GlyphStore store;
  const auto first = fill(store);
  store.begin(GlyphStore::kMostPages + 1);
  EXPECT_FALSE(put(store, kLarge)) << "nothing was drawn yet";
  store.adopt(1);  // the overlay with the first page's letters
  EXPECT_FALSE(put(store, kLarge));
  EXPECT_TRUE(store.holds(first[0]));
  store.adopt(2);
  EXPECT_TRUE(put(store, kLarge));
}

}  // namespace
