#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace emulator::studio {

enum class Sex : std::uint8_t { kMale, kFemale };
enum class HairCut : std::uint8_t { kShort, kFull, kTail };

/// Who a body is. Colours are linear light, 0..1.
struct BodyShape {
  double height_m = 1.80;  ///< 1.50..2.05
  double build = 0;        ///< -1 slight .. 1 heavy
  Sex sex = Sex::kMale;
  HairCut hair_cut = HairCut::kShort;
  Eigen::Vector3f skin{0.56F, 0.33F, 0.22F};
  Eigen::Vector3f hair{0.045F, 0.026F, 0.015F};
  Eigen::Vector3f eye{0.10F, 0.16F, 0.20F};
  Eigen::Vector3f shirt{0.55F, 0.035F, 0.04F};
  Eigen::Vector3f shirt_trim{0.85F, 0.85F, 0.85F};
  Eigen::Vector3f shorts{0.02F, 0.025F, 0.05F};
  Eigen::Vector3f shoe{0.05F, 0.22F, 0.50F};
  int number = 7;  ///< on the shirt, 0..99
  bool left_handed = false;
  double cell_scale = 1;  ///< of the polygons; 2 for people who stay far away
  std::uint64_t seed = 1;
};

}  // namespace emulator::studio
