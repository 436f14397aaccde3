#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace bench {

// The members of a comparison's line that the table shows.
inline constexpr const char* kBenchmark = "benchmark";
inline constexpr const char* kWhat = "what";
inline constexpr const char* kUnit = "unit";
inline constexpr const char* kOurs = "ours";
inline constexpr const char* kRival = "rival";
inline constexpr const char* kOursFigure = "ours_figure";
inline constexpr const char* kRivalFigure = "rival_figure";
inline constexpr const char* kRatio = "ratio";
inline constexpr const char* kBar = "bar";
inline constexpr const char* kVerdict = "verdict";

/// One line per comparison: what, ours, rival, ratio, bar, verdict.
void printTable(const std::vector<nlohmann::json>& rows);

}  // namespace bench
