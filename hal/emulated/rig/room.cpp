#include "hal/emulated/rig/room.h"

#include <array>
#include <limits>
#include <vector>

#include "hal/emulated/rig/mannequin.h"

namespace emulator {
namespace {

constexpr float kHalfWidth_m = 7.0f;
constexpr float kHalfDepth_m = 6.0f;
constexpr float kCeiling_m = 4.8f;
constexpr float kWainscot_m = 1.15f;  // the walls' lower part

constexpr Vec3 kRubber = {0.115f, 0.135f, 0.155f};
constexpr Vec3 kGridLine = {0.22f, 0.25f, 0.28f};
constexpr Vec3 kWhitePaint = {0.70f, 0.70f, 0.68f};
constexpr Vec3 kOrange = {0.72f, 0.24f, 0.03f};
constexpr Vec3 kTeal = {0.03f, 0.30f, 0.33f};
constexpr Vec3 kYellow = {0.72f, 0.50f, 0.05f};
constexpr Vec3 kUpperWall = {0.50f, 0.50f, 0.47f};
constexpr Vec3 kLowerWall = {0.10f, 0.19f, 0.24f};
constexpr Vec3 kSeam = {0.33f, 0.34f, 0.33f};

/// 1 inside a line of @p width around @p centre, soft over @p pixel.
float line(float at, float centre, float width, float pixel) {
  const float coverage = (width * 0.5f - std::abs(at - centre)) / pixel + 0.5f;
  return clamp01(coverage) * std::min(1.0f, width / pixel);
}
float grid(float at, float spacing, float width, float pixel) {
  return line(at - std::round(at / spacing) * spacing, 0, width, pixel);
}
/// 1 above an edge.
float above(float at, float edge, float pixel) {
  return clamp01((at - edge) / pixel + 0.5f);
}

Vec3 floorAlbedo(Vec3 p, float pixel) {
  Vec3 colour = kRubber;
  const float fine = std::max(grid(p.x, 0.5f, 0.012f, pixel), grid(p.y, 0.5f, 0.012f, pixel));
  colour = mix(colour, kGridLine, 0.7f * fine);
  const float radius = std::hypot(p.x, p.y);
  colour = mix(colour, {0.05f, 0.17f, 0.20f}, above(-radius, -1.25f, pixel));
  const float disc_grid =
      radius < 1.25f ? std::max(grid(p.x, 0.25f, 0.008f, pixel), grid(p.y, 0.25f, 0.008f, pixel))
                     : 0.0f;
  colour = mix(colour, {0.10f, 0.27f, 0.30f}, 0.7f * disc_grid);
  colour = mix(colour, kOrange, line(radius, 1.25f, 0.06f, pixel));
  colour = mix(colour, kWhitePaint, line(std::abs(p.x), 2.2f, 0.05f, pixel));
  colour = mix(colour, kYellow, line(p.y, 2.6f, 0.05f, pixel));
  colour = mix(colour, kTeal, line(p.y, 3.6f, 0.10f, pixel));
  return colour;
}

/// @p along  metres along the wall; @p wall is the wall's number.
Vec3 wallAlbedo(float along, float z, int wall, float pixel) {
  Vec3 colour = mix(kLowerWall, kUpperWall, above(z, kWainscot_m, pixel));
  colour = mix(colour, kSeam, 0.6f * grid(along + 0.6f, 1.2f, 0.02f, pixel));
  colour = mix(colour, kOrange, line(z, kWainscot_m, 0.07f, pixel));
  colour = mix(colour, kLowerWall, line(z, 0.05f, 0.10f, pixel));
  // Coloured panels, so that neighbouring views differ at a glance.
  constexpr std::array<Vec3, 4> kPanels = {kTeal, kYellow, kOrange, {0.16f, 0.10f, 0.30f}};
  constexpr float kSpacing_m = 2.4f;
  const float number = std::round(along / kSpacing_m);
  const float inside_x = above(0.42f - std::abs(along - number * kSpacing_m), 0, pixel);
  const float inside_z = above(0.55f - std::abs(z - 2.25f), 0, pixel);
  const auto index = static_cast<std::size_t>(static_cast<int>(number) + 8 + wall * 3) % 4;
  return mix(colour, kPanels[index], 0.85f * inside_x * inside_z);
}

Vec3 ceiling(Vec3 p, float pixel) {
  const float lamp_x = above(0.25f - std::abs(p.x - std::round(p.x / 2.4f) * 2.4f), 0, pixel);
  const float lamp_y = above(0.9f - std::abs(p.y - std::round(p.y / 3.0f) * 3.0f), 0, pixel);
  return mix({0.16f, 0.165f, 0.17f}, {0.95f, 0.95f, 0.92f}, lamp_x * lamp_y);
}

float lambert(Vec3 point, Vec3 normal, Vec3 light, float intensity) {
  const Vec3 to = light - point;
  const float distance2 = dot(to, to);
  return intensity * std::max(dot(normal, to), 0.0f) / (distance2 * std::sqrt(distance2));
}

/// How much of each light reaches a place.
struct Visibility {
  float key = 1;
  float fill = 1;
  float ambient = 1;
};

/// The figure's shadow on the floor, the same for all cameras: computed once, then looked up.
class FloorShadow {
 public:
  FloorShadow() : texels_(std::size_t{kSide} * kSide) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const Vec3 p = {(static_cast<float>(column) - kCentre) * kTexel_m,
                        (static_cast<float>(row) - kCentre) * kTexel_m, 0};
        // The figure's feet darken the floor that they almost touch.
        const float ambient = 0.55f + 0.45f * clamp01(mannequinDistance(p) / 0.35f);
        at(column, row) = {mannequinShadow(p, kKeyLight, 0.10f),
                           mannequinShadow(p, kFillLight, 0.12f), ambient};
      }
    }
  }

  [[nodiscard]] Visibility operator()(Vec3 p) const {
    const float u = p.x / kTexel_m + kCentre;
    const float v = p.y / kTexel_m + kCentre;
    if (u < 0 || v < 0 || u >= kSide - 1 || v >= kSide - 1) return {};
    const int column = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float fu = u - static_cast<float>(column);
    const float fv = v - static_cast<float>(row);
    return mix(mix(at(column, row), at(column + 1, row), fu),
               mix(at(column, row + 1), at(column + 1, row + 1), fu), fv);
  }

 private:
  static constexpr int kSide = 280;
  static constexpr float kCentre = kSide / 2.0f;
  static constexpr float kTexel_m = 0.02f;

  static Visibility mix(const Visibility& a, const Visibility& b, float t) {
    return {std::lerp(a.key, b.key, t), std::lerp(a.fill, b.fill, t),
            std::lerp(a.ambient, b.ambient, t)};
  }
  [[nodiscard]] static std::size_t index(int column, int row) {
    return std::size_t{kSide} * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
  }
  Visibility& at(int column, int row) { return texels_[index(column, row)]; }
  [[nodiscard]] const Visibility& at(int column, int row) const {
    return texels_[index(column, row)];
  }

  std::vector<Visibility> texels_;
};

Vec3 lit(Vec3 albedo, Vec3 point, Vec3 normal, const Visibility& visible) {
  const float key = visible.key * lambert(point, normal, kKeyLight, 22);
  const float fill = visible.fill * lambert(point, normal, kFillLight, 14);
  const float ambient = visible.ambient * 0.42f;
  return albedo * (Vec3{1.0f, 0.96f, 0.90f} * key + Vec3{0.92f, 0.97f, 1.0f} * fill +
                   Vec3{1, 1, 1} * ambient);
}

/// Distance along the ray to the plane axis = value, or infinity.
float toPlane(float origin, float direction, float low, float high) {
  if (direction > 0) return (high - origin) / direction;
  if (direction < 0) return (low - origin) / direction;
  return std::numeric_limits<float>::max();
}

}  // namespace

Vec3 shadeRoom(Vec3 origin, Vec3 direction, float footprint) {
  const float tx = toPlane(origin.x, direction.x, -kHalfWidth_m, kHalfWidth_m);
  const float ty = toPlane(origin.y, direction.y, -kHalfDepth_m, kHalfDepth_m);
  const float tz = toPlane(origin.z, direction.z, 0, kCeiling_m);
  const float t = std::min({tx, ty, tz});
  const Vec3 p = origin + direction * t;

  if (t == tz) {
    const float pixel = footprint * t / std::max(std::abs(direction.z), 0.05f);
    if (direction.z > 0) return ceiling(p, pixel);
    static const FloorShadow shadow;
    return lit(floorAlbedo(p, pixel), p, {0, 0, 1}, shadow(p));
  }
  if (t == tx) {
    const float pixel = footprint * t / std::max(std::abs(direction.x), 0.05f);
    const Vec3 normal = {direction.x > 0 ? -1.0f : 1.0f, 0, 0};
    return lit(wallAlbedo(p.y, p.z, direction.x > 0 ? 1 : 2, pixel), p, normal, {});
  }
  const float pixel = footprint * t / std::max(std::abs(direction.y), 0.05f);
  const Vec3 normal = {0, direction.y > 0 ? -1.0f : 1.0f, 0};
  return lit(wallAlbedo(p.x, p.z, 0, pixel), p, normal, {});
}

}  // namespace emulator
