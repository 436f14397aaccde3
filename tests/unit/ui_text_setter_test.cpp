#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "ui-kms/text_setter.h"

namespace {

using hal::Overlay;
using hal::OverlayItem;

class TextSetterTest : public testing::Test {
 protected:
  void SetUp() override {
    auto fonts = ui::FontSet::create("");
    if (!fonts) GTEST_SKIP() << fonts.error();
    setter_ = std::make_unique<ui::TextSetter>(std::move(*fonts), *store_);
  }

  float set(const std::string& text, float room_px = 10'000, float size_px = 24) {
    setter_->begin(*overlay_);
    const float width_px =
        setter_->set(*overlay_, text,
                     {.x_px = 10, .baseline_px = 50, .width_px = room_px, .size_px = size_px}, {});
    setter_->finish(*overlay_);
    while (store_->tryPopUpload()) {
    }
    store_->adopt(overlay_->generation);
    return width_px;
  }

  std::unique_ptr<ui::GlyphStore> store_ = std::make_unique<ui::GlyphStore>();
  std::unique_ptr<ui::TextSetter> setter_;
  std::unique_ptr<Overlay> overlay_ = std::make_unique<Overlay>();
};

TEST_F(TextSetterTest, ALineIsItsLettersFromLeftToRight) {
  set("LIVE 7");
  ASSERT_EQ(overlay_->count, 5U);  // a space is drawn by nothing
  for (std::uint32_t i = 0; i < overlay_->count; ++i) {
    EXPECT_EQ(overlay_->items[i].kind, OverlayItem::Kind::kGlyph);
    EXPECT_TRUE(i == 0 || overlay_->items[i].x_px > overlay_->items[i - 1].x_px);
  }
}

TEST_F(TextSetterTest, ALetterIsRasterisedOncePerSize) {
  set("7777");
  EXPECT_EQ(overlay_->glyphs, 1U);
  set("77");
  EXPECT_EQ(overlay_->glyphs, 1U);
  set("7", 10'000, 40);
  EXPECT_EQ(overlay_->glyphs, 2U);
}

TEST_F(TextSetterTest, EveryOverlayHasItsOwnNumber) {
  set("a");
  const std::uint64_t first = overlay_->generation;
  set("a");
  EXPECT_GT(overlay_->generation, first);
}

TEST_F(TextSetterTest, WhatFitsIsNotShortened) {
  const float width_px = setter_->widthPx("camera 7 lost", 24);
  EXPECT_FLOAT_EQ(set("camera 7 lost", width_px), width_px);
  EXPECT_LT(set("camera 7 lost", width_px - 1), width_px);
}

TEST_F(TextSetterTest, AShortenedTextFitsWhateverItsRoom) {
  for (float room_px = 0; room_px < 400; room_px += 7) {
    EXPECT_LE(set("Kamera 7 hat kein Bild von diesem Augenblick", room_px), room_px);
  }
}

TEST_F(TextSetterTest, AShortenedTextEndsBehindALetterAndItsMarks) {
  const std::string marked = "xe\u0301\u0302\u0323x";  // e with three marks
  const float whole_px = setter_->widthPx(marked + "xxxx", 24);
  const float ellipsis_px = setter_->widthPx("\u2026", 24);
  for (float room_px = ellipsis_px; room_px < whole_px; ++room_px) {
    const float width_px = set(marked + "xxxx", room_px);
    const float x_px = setter_->widthPx("x\u2026", 24);
    const float marked_px = setter_->widthPx("xe\u0301\u0302\u0323\u2026", 24);
    // Never between the two: x and a bare e.
    EXPECT_TRUE(width_px <= x_px + 0.1F || width_px >= marked_px - 0.1F) << room_px;
  }
}

TEST_F(TextSetterTest, ALetterThatNoFontHasIsABoxAndReportedOnce) {
  EXPECT_EQ(setter_->takeWarning(), "");
  const float width_px = set("\U000FFFFD");
  EXPECT_GT(width_px, 0);
  EXPECT_EQ(overlay_->count, 1U);
  const std::string warning = setter_->takeWarning();
  EXPECT_NE(warning.find("U+FFFFD"), std::string::npos) << warning;
  EXPECT_NE(warning.find("fonts-ipaexfont-gothic"), std::string::npos) << warning;
  set("\U000FFFFD \U000FFFFC");
  EXPECT_EQ(setter_->takeWarning(), "");
}

TEST_F(TextSetterTest, BytesThatAreNoUtf8AreLettersToo) {
  for (const char* text :
       {"\xff\xfe", "\xe3\x81", "a\xc0\xafz", "\xf5\x80\x80\x80", "\xed\xa0\x80"}) {
    EXPECT_GT(set(text), 0) << text;
    EXPECT_EQ(overlay_->refused, 0U);
  }
}

TEST_F(TextSetterTest, MoreLettersThanAnOverlayHoldsAreCounted) {
  setter_->begin(*overlay_);
  for (int line = 0; line < 11; ++line) {
    setter_->set(*overlay_, std::string(100, 'o'), {.width_px = 1e6F, .size_px = 10}, {});
  }
  setter_->finish(*overlay_);
  EXPECT_EQ(overlay_->count, Overlay::kMostItems);
  EXPECT_EQ(overlay_->refused, 1'100 - Overlay::kMostItems);
}

}  // namespace
