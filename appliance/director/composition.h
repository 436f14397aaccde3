#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "rt/annotations.h"

namespace appliance {

/// How two shots share the picture.
enum class Layout : std::uint8_t {
  kSingle,      ///< the first alone
  kSideBySide,  ///< each in its half, the target in the middle of both
  kGhost,       ///< the second over the first, partly transparent
  kWipe,        ///< the first up to a vertical line, the second beyond it
};

struct LayoutRow {
  Layout layout;
  std::string_view name;  ///< on the command line and the bus
};

inline constexpr std::array<LayoutRow, 4> kLayouts = {{{Layout::kSingle, "single"},
                                                       {Layout::kSideBySide, "side-by-side"},
                                                       {Layout::kGhost, "ghost"},
                                                       {Layout::kWipe, "wipe"}}};
static_assert(std::ranges::all_of(kLayouts, [](const LayoutRow& row) {
  return &row == &kLayouts[static_cast<std::size_t>(row.layout)];
}));

[[nodiscard]] constexpr std::optional<Layout> layoutNamed(std::string_view name) {
  const auto* row = std::ranges::find(kLayouts, name, &LayoutRow::name);
  if (row == kLayouts.end()) return std::nullopt;
  return row->layout;
}

struct Composition {
  Layout layout = Layout::kSingle;
  /// kGhost: the second's opacity. kWipe: the part of the width that the first keeps. 0 to 1.
  float share = 0.5F;

  friend bool operator==(const Composition&, const Composition&) = default;
};

/// Where one shot is drawn. Lengths are shares of the picture's width.
struct Place {
  float left = 0;
  float right = 1;
  float centre = 0.5F;  ///< where the target is drawn
  float opacity = 1;

  friend bool operator==(const Place&, const Place&) = default;
};

/// The places of the first and the second shot, in the order in which they are drawn.
struct Arrangement {
  std::array<Place, 2> places{};
  std::uint32_t count = 1;
};

[[nodiscard]] constexpr Arrangement arrange(const Composition& composition) RT_SAFE {
  const float share = std::clamp(composition.share, 0.0F, 1.0F);
  switch (composition.layout) {
    case Layout::kSingle:
      break;
    case Layout::kSideBySide:
      return {.places = {{{.right = 0.5F, .centre = 0.25F}, {.left = 0.5F, .centre = 0.75F}}},
              .count = 2};
    case Layout::kGhost:
      return {.places = {{{}, {.opacity = share}}}, .count = 2};
    case Layout::kWipe:
      return {.places = {{{.right = share}, {.left = share}}}, .count = 2};
  }
  return {};
}

}  // namespace appliance
