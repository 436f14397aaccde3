#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>

/// The machine-readable half of the stamp card: which camera and which trigger a picture
/// shows, painted as a grid of black and white cells. Pure; tests read it back from shown
/// pictures through the inverse homography.
namespace emulator {

struct Stamp {
  std::uint8_t camera = 0;    ///< from 0
  std::uint32_t trigger = 0;  ///< from 1; the low 32 bits
  friend bool operator==(const Stamp&, const Stamp&) = default;
};

/// Where the card lies in a sensor's picture and how large its cells are, in whole pixels; even,
/// so that the Bayer pattern keeps the cells grey.
struct StampLayout {
  static constexpr int kColumns = 24;
  static constexpr int kRows = 3;
  static constexpr int kFullCellPx = 16;
  static constexpr int kHalfCellPx = 8;  ///< in pictures that cannot hold the full card
  static constexpr int kMinWidthPx = 224;
  static constexpr int kMinHeightPx = 160;

  int left_px = 0;
  int top_px = 0;
  int cell_px = kFullCellPx;

  [[nodiscard]] constexpr int cardWidth() const { return (kColumns + 2) * cell_px; }
  [[nodiscard]] constexpr int cardHeight() const { return (kRows + 3) * cell_px; }
  [[nodiscard]] constexpr int gridLeft() const { return cell_px; }
  [[nodiscard]] constexpr int gridTop() const { return cell_px * 5 / 2; }  ///< below the text

  /// Centred, in the upper part: inside a 16:9 crop of the middle, above the athlete's head.
  [[nodiscard]] static constexpr StampLayout of(int width_px, int height_px) {
    const bool full = width_px >= 2 * kMinWidthPx && height_px >= 2 * kMinHeightPx;
    StampLayout layout{.cell_px = full ? kFullCellPx : kHalfCellPx};
    const int cropped = height_px > width_px * 9 / 16 ? (height_px - width_px * 9 / 16) / 2 : 0;
    layout.left_px = (width_px - layout.cardWidth()) / 2 & ~1;
    layout.top_px = (cropped + layout.cell_px * 3 / 2) & ~1;
    return layout;
  }

  /// The middle of a cell, integer coordinates at pixel centres.
  [[nodiscard]] constexpr double cellX(int column) const {
    return left_px + gridLeft() + column * cell_px + (cell_px - 1) * 0.5;
  }
  [[nodiscard]] constexpr double cellY(int row) const {
    return top_px + gridTop() + row * cell_px + (cell_px - 1) * 0.5;
  }
};

/// Row by row, true for white: 16 alternating reference cells, camera (8), trigger (32),
/// CRC-16 of the two (16); each field's highest bit first.
using StampCells = std::array<bool, StampLayout::kColumns * StampLayout::kRows>;

namespace stamp_detail {

inline constexpr int kReferenceCells = 16;

/// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff.
[[nodiscard]] constexpr std::uint16_t crc(const Stamp& stamp) {
  std::uint16_t value = 0xffff;
  const auto feed = [&value](std::uint8_t byte) {
    value = static_cast<std::uint16_t>(value ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit) {
      value = static_cast<std::uint16_t>((value & 0x8000) != 0 ? value << 1 ^ 0x1021 : value << 1);
    }
  };
  feed(stamp.camera);
  for (int shift = 24; shift >= 0; shift -= 8) {
    feed(static_cast<std::uint8_t>(stamp.trigger >> shift));
  }
  return value;
}

constexpr bool isReferenceWhite(int index) {
  return index % 2 == 0;
}

}  // namespace stamp_detail

[[nodiscard]] constexpr StampCells encodeStamp(const Stamp& stamp) {
  StampCells cells{};
  std::size_t at = 0;
  for (int i = 0; i < stamp_detail::kReferenceCells; ++i) {
    cells[at++] = stamp_detail::isReferenceWhite(i);
  }
  const auto put = [&](std::uint32_t value, int bits) {
    for (int bit = bits - 1; bit >= 0; --bit) cells[at++] = (value >> bit & 1) != 0;
  };
  put(stamp.camera, 8);
  put(stamp.trigger, 32);
  put(stamp_detail::crc(stamp), 16);
  return cells;
}

/// Reads a stamp through @p luma(x_px, y_px), the brightness at a place of the source
/// picture in any unit that grows with light. Nothing when the reference cells or the
/// checksum do not fit: the card is not there, covered or displaced.
template <std::invocable<double, double> Sampler>
[[nodiscard]] std::optional<Stamp> decodeStamp(const StampLayout& layout, Sampler&& luma) {
  std::array<double, StampLayout::kColumns * StampLayout::kRows> light{};
  double white = 0;
  double black = 0;
  for (int i = 0; i < static_cast<int>(light.size()); ++i) {
    const int row = i / StampLayout::kColumns;
    const int column = i % StampLayout::kColumns;
    const auto value = static_cast<double>(luma(layout.cellX(column), layout.cellY(row)));
    light[static_cast<std::size_t>(i)] = value;
    if (i < stamp_detail::kReferenceCells) {
      (stamp_detail::isReferenceWhite(i) ? white : black) += value;
    }
  }
  const double threshold = (white + black) / stamp_detail::kReferenceCells;
  std::size_t at = 0;
  for (int i = 0; i < stamp_detail::kReferenceCells; ++i) {
    if ((light[at++] > threshold) != stamp_detail::isReferenceWhite(i)) return std::nullopt;
  }
  const auto take = [&](int bits) {
    std::uint32_t value = 0;
    for (int i = 0; i < bits; ++i) value = value << 1 | (light[at++] > threshold ? 1u : 0u);
    return value;
  };
  const Stamp stamp{static_cast<std::uint8_t>(take(8)), take(32)};
  if (take(16) != stamp_detail::crc(stamp)) return std::nullopt;
  return stamp;
}

}  // namespace emulator
