#pragma once

#include <algorithm>
#include <cmath>

namespace emulator {

/// A point, a direction or a colour (linear light) of the drawn scene.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
};

[[nodiscard]] constexpr float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline float length(Vec3 a) {
  return std::sqrt(dot(a, a));
}
[[nodiscard]] inline Vec3 unit(Vec3 a) {
  return a * (1 / length(a));
}
[[nodiscard]] constexpr Vec3 mix(Vec3 a, Vec3 b, float t) {
  return a * (1 - t) + b * t;
}
[[nodiscard]] constexpr float clamp01(float v) {
  return std::clamp(v, 0.0f, 1.0f);
}

}  // namespace emulator
