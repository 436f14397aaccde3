#include "hal/emulated/rig/stamp_card.h"

#include <cstdio>
#include <cstring>

#include <opencv2/imgproc.hpp>

namespace emulator {
namespace {

constexpr std::uint8_t kWhite = 235;  // linear light, near full scale
constexpr std::uint8_t kBlack = 4;
constexpr char kFirstGlyph = ' ';
constexpr char kLastGlyph = 'Z';
constexpr int kGlyphWidthPx = 18;
constexpr int kGlyphHeightPx = 26;
constexpr int kTextTopPx = 8;
constexpr int kTextColumns = 22;  // "CAM 07  TRIGGER 001234"
constexpr int kTriggerColumn = 16;
constexpr int kTextLeftPx = (StampLayout::kCardWidthPx - kTextColumns * kGlyphWidthPx) / 2;
constexpr unsigned kShownTriggers = 1'000'000;

std::vector<std::uint8_t> drawGlyph(char character) {
  cv::Mat glyph(kGlyphHeightPx, kGlyphWidthPx, CV_8UC1, cv::Scalar(kWhite));
  const std::string text(1, character);
  constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
  constexpr double kScale = 0.7;
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, kScale, 2, &baseline);
  const cv::Point at((kGlyphWidthPx - size.width) / 2, (kGlyphHeightPx + size.height) / 2);
  cv::putText(glyph, text, at, kFont, kScale, cv::Scalar(kBlack), 2, cv::LINE_AA);
  return {glyph.datastart, glyph.dataend};
}

}  // namespace

StampCard::StampCard() {
  for (char c = kFirstGlyph; c <= kLastGlyph; ++c) glyphs_.push_back(drawGlyph(c));
}

void StampCard::paintText(std::uint8_t* card_origin, std::size_t stride_bytes, int column,
                          const char* text) const {
  std::uint8_t* to = card_origin + kTextTopPx * stride_bytes + kTextLeftPx + column * kGlyphWidthPx;
  for (; *text != '\0'; ++text, to += kGlyphWidthPx) {
    const auto& glyph = glyphs_[static_cast<std::size_t>(*text - kFirstGlyph)];
    for (std::size_t row = 0; row < kGlyphHeightPx; ++row) {
      std::memcpy(to + row * stride_bytes, &glyph[row * kGlyphWidthPx], kGlyphWidthPx);
    }
  }
}

void StampCard::paintFrame(std::uint8_t* card_origin, std::size_t stride_bytes,
                           std::uint8_t camera) const {
  for (std::size_t row = 0; row < StampLayout::kCardHeightPx; ++row) {
    std::memset(card_origin + row * stride_bytes, kWhite, StampLayout::kCardWidthPx);
  }
  char text[32];
  std::snprintf(text, sizeof text, "CAM %02u  TRIGGER", unsigned{camera} + 1);
  paintText(card_origin, stride_bytes, 0, text);
}

void StampCard::paintTrigger(std::uint8_t* card_origin, std::size_t stride_bytes,
                             const Stamp& stamp) const {
  char text[16];
  std::snprintf(text, sizeof text, "%06u", static_cast<unsigned>(stamp.trigger % kShownTriggers));
  paintText(card_origin, stride_bytes, kTriggerColumn, text);

  const StampCells cells = encodeStamp(stamp);
  std::uint8_t* grid =
      card_origin + StampLayout::kGridTopPx * stride_bytes + StampLayout::kGridLeftPx;
  constexpr std::size_t kRowBytes = std::size_t{StampLayout::kColumns} * StampLayout::kCellPx;
  for (std::size_t row = 0; row < StampLayout::kRows; ++row) {
    std::uint8_t* first = grid + row * StampLayout::kCellPx * stride_bytes;
    for (std::size_t column = 0; column < StampLayout::kColumns; ++column) {
      const bool white = cells[row * StampLayout::kColumns + column];
      std::memset(first + column * StampLayout::kCellPx, white ? kWhite : kBlack,
                  StampLayout::kCellPx);
    }
    for (std::size_t line = 1; line < StampLayout::kCellPx; ++line) {
      std::memcpy(first + line * stride_bytes, first, kRowBytes);
    }
  }
}

}  // namespace emulator
