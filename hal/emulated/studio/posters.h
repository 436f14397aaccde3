#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace emulator::studio {

/// Where a poster's picture lies in the sheet of all posters; (0, 0) is the sheet's lower left.
struct PosterPlace {
  Eigen::Vector2f low;
  Eigen::Vector2f high;
  float aspect = 1;  ///< width by height
};

enum class Wall : std::uint8_t { kBack, kLeft, kRight };

struct HungPoster {
  std::uint32_t poster = 0;
  Wall wall = Wall::kBack;
  float along_m = 0;  ///< its middle: x on the back wall, y on the others
  float low_m = 0;
  float height_m = 0;
};

[[nodiscard]] PosterPlace posterPlace(std::uint32_t poster);
[[nodiscard]] std::vector<HungPoster> hungPosters();
/// All posters, banners, the scoreboard and the clock on one sheet: RGB, sRGB curve.
[[nodiscard]] cv::Mat drawPosters(std::uint64_t seed);

}  // namespace emulator::studio
