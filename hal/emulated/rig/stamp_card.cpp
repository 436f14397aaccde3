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
constexpr int kTextColumns = 22;  // "CAM 07  TRIGGER 001234"
constexpr int kTriggerColumn = 16;
constexpr unsigned kShownTriggers = 1'000'000;

// The text's measures follow the cells.
int glyphWidth(const StampLayout& layout) {
  return layout.cell_px * 9 / 8;
}
int glyphHeight(const StampLayout& layout) {
  return layout.cell_px * 13 / 8;
}
int textTop(const StampLayout& layout) {
  return layout.cell_px / 2;
}
int textLeft(const StampLayout& layout) {
  return (layout.cardWidth() - kTextColumns * glyphWidth(layout)) / 2;
}

std::vector<std::uint8_t> drawGlyph(const StampLayout& layout, char character) {
  const int width_px = glyphWidth(layout);
  const int height_px = glyphHeight(layout);
  cv::Mat glyph(height_px, width_px, CV_8UC1, cv::Scalar(kWhite));
  const std::string text(1, character);
  constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
  const double scale = 0.7 / StampLayout::kFullCellPx * layout.cell_px;
  const int stroke_px = layout.cell_px / 8;
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, stroke_px, &baseline);
  const cv::Point at((width_px - size.width) / 2, (height_px + size.height) / 2);
  cv::putText(glyph, text, at, kFont, scale, cv::Scalar(kBlack), stroke_px, cv::LINE_AA);
  return {glyph.datastart, glyph.dataend};
}

}  // namespace

StampCard::StampCard(const StampLayout& layout) : layout_(layout) {
  for (char c = kFirstGlyph; c <= kLastGlyph; ++c) glyphs_.push_back(drawGlyph(layout, c));
}

void StampCard::paintText(std::uint8_t* card_origin, std::size_t stride_bytes, int column,
                          const char* text) const {
  const auto width = static_cast<std::size_t>(glyphWidth(layout_));
  const auto height = static_cast<std::size_t>(glyphHeight(layout_));
  std::uint8_t* to = card_origin + static_cast<std::size_t>(textTop(layout_)) * stride_bytes +
                     textLeft(layout_) + column * glyphWidth(layout_);
  for (; *text != '\0'; ++text, to += width) {
    const auto& glyph = glyphs_[static_cast<std::size_t>(*text - kFirstGlyph)];
    for (std::size_t row = 0; row < height; ++row) {
      std::memcpy(to + row * stride_bytes, &glyph[row * width], width);
    }
  }
}

void StampCard::paintFrame(std::uint8_t* card_origin, std::size_t stride_bytes,
                           std::uint8_t camera) const {
  const auto width = static_cast<std::size_t>(layout_.cardWidth());
  for (std::size_t row = 0; row < static_cast<std::size_t>(layout_.cardHeight()); ++row) {
    std::memset(card_origin + row * stride_bytes, kWhite, width);
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
      card_origin + static_cast<std::size_t>(layout_.gridTop()) * stride_bytes + layout_.gridLeft();
  const auto cell = static_cast<std::size_t>(layout_.cell_px);
  const std::size_t row_bytes = std::size_t{StampLayout::kColumns} * cell;
  for (std::size_t row = 0; row < StampLayout::kRows; ++row) {
    std::uint8_t* first = grid + row * cell * stride_bytes;
    for (std::size_t column = 0; column < StampLayout::kColumns; ++column) {
      const bool white = cells[row * StampLayout::kColumns + column];
      std::memset(first + column * cell, white ? kWhite : kBlack, cell);
    }
    for (std::size_t line = 1; line < cell; ++line) {
      std::memcpy(first + line * stride_bytes, first, row_bytes);
    }
  }
}

}  // namespace emulator
