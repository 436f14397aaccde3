#include "hal/emulated/studio/athlete/noise.h"

#include <cmath>

namespace emulator::studio {
namespace {

float lattice(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed + static_cast<std::uint32_t>(x) * 0x8DA6B343U +
                    static_cast<std::uint32_t>(y) * 0xD8163841U +
                    static_cast<std::uint32_t>(z) * 0xCB1AB31FU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  h ^= h >> 15;
  return static_cast<float>(h & 0xFFFFU) / 32767.5F - 1.0F;
}

float fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}
float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

}  // namespace

float smoothNoise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const float fx = std::floor(p.x());
  const float fy = std::floor(p.y());
  const float fz = std::floor(p.z());
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  const int z = static_cast<int>(fz);
  const float u = fade(p.x() - fx);
  const float v = fade(p.y() - fy);
  const float w = fade(p.z() - fz);
  const auto row = [&](int j, int k) {
    return mix(lattice(x, y + j, z + k, seed), lattice(x + 1, y + j, z + k, seed), u);
  };
  return mix(mix(row(0, 0), row(1, 0), v), mix(row(0, 1), row(1, 1), v), w);
}

}  // namespace emulator::studio
