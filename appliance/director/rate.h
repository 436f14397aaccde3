#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace appliance {

/// How fast stored time is played. Time runs forward only: a coach wants the movement as it
/// happened, single moments are reached backwards by stepping, and the end of the memory would come
/// towards a playhead that runs backwards at the sum of both speeds.
enum class Rate : std::uint8_t { kStill, kEighth, kQuarter, kHalf, kFull };

struct RateRow {
  Rate rate;
  double factor;          ///< triggers played in one trigger period
  std::string_view name;  ///< on the screen, the command line and the bus
};

inline constexpr std::array<RateRow, 5> kRates = {{{Rate::kStill, 0, "0"},
                                                   {Rate::kEighth, 0.125, "1/8"},
                                                   {Rate::kQuarter, 0.25, "1/4"},
                                                   {Rate::kHalf, 0.5, "1/2"},
                                                   {Rate::kFull, 1, "1"}}};
static_assert(std::ranges::all_of(kRates, [](const RateRow& row) {
  return &row == &kRates[static_cast<std::size_t>(row.rate)];
}));

[[nodiscard]] constexpr double factorOf(Rate rate) {
  return kRates[static_cast<std::size_t>(rate)].factor;
}

[[nodiscard]] constexpr std::string_view nameOf(Rate rate) {
  return kRates[static_cast<std::size_t>(rate)].name;
}

[[nodiscard]] constexpr std::optional<Rate> rateNamed(std::string_view name) {
  const auto* row = std::ranges::find(kRates, name, &RateRow::name);
  if (row == kRates.end()) return std::nullopt;
  return row->rate;
}

/// What the SPEED button goes to: 1/2, 1/4, 1/8, then full speed again.
[[nodiscard]] constexpr Rate nextSlower(Rate rate) {
  switch (rate) {
    case Rate::kHalf:
      return Rate::kQuarter;
    case Rate::kQuarter:
      return Rate::kEighth;
    case Rate::kEighth:
      return Rate::kFull;
    case Rate::kStill:
    case Rate::kFull:
      return Rate::kHalf;
  }
  return Rate::kFull;
}

}  // namespace appliance
