#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "hal/emulated/studio/lamps.h"
#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// Light that falls on each surface of the empty hall, on one sheet: red, green, blue irradiance
/// over pi (so a white surface sends out just that), and how far its luminance swings at second 0.
struct LightMap {
  struct Place {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;  ///< texels; the outermost lie on the surface's edges
    std::uint32_t height = 0;
  };
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Place> places;            ///< one per surface
  std::vector<Eigen::Vector4f> texels;  ///< row-major
};

/// Light at a place in the room from everything but the key lamps: per direction +x -x +y -y +z -z
/// the irradiance over pi of a plate that faces there. On a grid over the floor at height 1 m.
struct LightProbes {
  static constexpr std::uint32_t kColumns = 5;
  static constexpr std::uint32_t kRows = 4;
  using Cube = std::array<Eigen::Vector3f, 6>;
  std::array<Cube, std::size_t{kColumns} * kRows> cubes{};

  [[nodiscard]] static Eigen::Vector2f positionOf(std::uint32_t column, std::uint32_t row);
  /// Between the grid's points, at its edge beyond them.
  [[nodiscard]] Cube at(const Eigen::Vector2f& place) const;
};

struct BakedLight {
  LightMap map;
  LightProbes probes;
};

/// Shadows of area lamps and one bounce, by rays: some seconds of every core.
/// @p progress  receives the share done, from one of the working threads.
[[nodiscard]] BakedLight bakeLight(const std::vector<Surface>& surfaces,
                                   const std::vector<Lamp>& lamps,
                                   const std::function<void(double)>& progress);

/// The luminance of the light on the floor, a value for each of its texels: CV_32F.
[[nodiscard]] cv::Mat floorLight(const std::vector<Surface>& surfaces, const LightMap& map);

}  // namespace emulator::studio
