#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/emulated/rig/stamp_code.h"

namespace emulator {

/// Paints stamp cards: "CAM 07  TRIGGER 001234" and below it the grid of stamp_code.h.
/// All glyphs are drawn once; a paint copies rows.
class StampCard {
 public:
  explicit StampCard(const StampLayout& layout);

  /// Paints the parts of the card that never change. @p card_origin is the card's top left
  /// pixel in a picture of @p stride_bytes per row.
  void paintFrame(std::uint8_t* card_origin, std::size_t stride_bytes, std::uint8_t camera) const;
  /// Paints the trigger number as text and the grid.
  void paintTrigger(std::uint8_t* card_origin, std::size_t stride_bytes, const Stamp& stamp) const;

 private:
  void paintText(std::uint8_t* card_origin, std::size_t stride_bytes, int column,
                 const char* text) const;

  StampLayout layout_;
  std::vector<std::vector<std::uint8_t>> glyphs_;  // by character, from ' ' to 'Z'
};

}  // namespace emulator
