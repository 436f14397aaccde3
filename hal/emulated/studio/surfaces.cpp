#include "hal/emulated/studio/surfaces.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace emulator::studio {

using Eigen::Vector2f;
using Eigen::Vector3f;

Vector3f Surface::at(float u, float v) const {
  return (corners[0] * (1 - u) + corners[1] * u) * (1 - v) +
         (corners[2] * (1 - u) + corners[3] * u) * v;
}

Vector3f Surface::normalAt(float u, float v) const {
  return ((normals[0] * (1 - u) + normals[1] * u) * (1 - v) +
          (normals[2] * (1 - u) + normals[3] * u) * v)
      .normalized();
}

void SurfaceBuilder::picture(const Vector3f& corner, const Vector3f& edge_u, const Vector3f& edge_v,
                             const Paint& paint, const Vector2f& low, const Vector2f& high) {
  Surface surface;
  surface.corners = {corner, corner + edge_u, corner + edge_v, corner + edge_u + edge_v};
  surface.normals.fill(edge_u.cross(edge_v).normalized());
  surface.texture = {low, Vector2f(high.x(), low.y()), Vector2f(low.x(), high.y()), high};
  surface.tint = paint.tint;
  surface.cover = paint.cover;
  surface.light_step_m = paint.light_step_m;
  surfaces_.push_back(surface);
}

void SurfaceBuilder::sheet(const Vector3f& corner, const Vector3f& edge_u, const Vector3f& edge_v,
                           const Paint& paint) {
  // Where a piece lies decides which part of the texture it shows: no two look alike.
  const Vector2f low(std::fmod(std::abs(corner.sum() * 1.37f), 1.0f),
                     std::fmod(std::abs(corner.x() * 0.73f + corner.z() * 2.1f), 1.0f));
  picture(corner, edge_u, edge_v, paint, low,
          low + Vector2f(edge_u.norm(), edge_v.norm()) / paint.tile_m);
}

void SurfaceBuilder::box(const Vector3f& centre, const Vector3f& size, float turn,
                         const Paint& paint) {
  const Eigen::AngleAxisf rotation(turn, Vector3f::UnitZ());
  const Vector3f x = rotation * Vector3f(size.x(), 0, 0);
  const Vector3f y = rotation * Vector3f(0, size.y(), 0);
  const Vector3f z(0, 0, size.z());
  const Vector3f low = centre - (x + y + z) / 2;
  sheet(low, x, z, paint);           // front, -y
  sheet(low + x + y, -x, z, paint);  // back
  sheet(low + y, -y, z, paint);      // left
  sheet(low + x, y, z, paint);       // right
  sheet(low + z, x, y, paint);       // top
  sheet(low + y, x, -y, paint);      // bottom
}

void SurfaceBuilder::bar(const Vector3f& from, const Vector3f& to, float radius, int sides,
                         const Paint& paint) {
  const Vector3f axis = (to - from).normalized();
  const Vector3f across = axis.unitOrthogonal();
  const Vector3f other = axis.cross(across);
  const float length = (to - from).norm();
  const auto direction = [&](int i) -> Vector3f {
    const float angle =
        2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
    return across * std::cos(angle) + other * std::sin(angle);
  };
  const float arc = 2 * std::numbers::pi_v<float> * radius / static_cast<float>(sides);
  for (int i = 0; i < sides; ++i) {
    const Vector3f a = direction(i);
    const Vector3f b = direction(i + 1);
    Surface surface;
    surface.corners = {from + a * radius, from + b * radius, to + a * radius, to + b * radius};
    surface.normals = {a, b, a, b};
    const float u = static_cast<float>(i) * arc / paint.tile_m;
    surface.texture = {Vector2f(u, 0), Vector2f(u + arc / paint.tile_m, 0),
                       Vector2f(u, length / paint.tile_m),
                       Vector2f(u + arc / paint.tile_m, length / paint.tile_m)};
    surface.tint = paint.tint;
    surface.cover = paint.cover;
    surface.light_step_m = paint.light_step_m;
    surfaces_.push_back(surface);
  }
  for (const auto& [end, outwards] : {std::pair{from, Vector3f(-axis)}, std::pair{to, axis}}) {
    const Vector3f u = across * (radius * 1.5f);
    const Vector3f v = outwards.cross(across) * (radius * 1.5f);
    sheet(end - (u + v) / 2, u, v, paint);
  }
}

void SurfaceBuilder::ball(const Vector3f& centre, float radius, const Paint& paint) {
  constexpr int kAround = 14;
  constexpr int kUp = 8;
  const auto direction = [](int i, int j) -> Vector3f {
    const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
    const float up = std::numbers::pi_v<float> * (static_cast<float>(j) / kUp - 0.5f);
    return {std::cos(around) * std::cos(up), std::sin(around) * std::cos(up), std::sin(up)};
  };
  for (int j = 0; j < kUp; ++j) {
    for (int i = 0; i < kAround; ++i) {
      Surface surface;
      for (std::size_t k = 0; k < 4; ++k) {
        const int column = i + static_cast<int>(k % 2);
        const int row = j + static_cast<int>(k / 2);
        surface.normals[k] = direction(column, row);
        surface.corners[k] = centre + surface.normals[k] * radius;
        surface.texture[k] = {static_cast<float>(column) / kAround, static_cast<float>(row) / kUp};
      }
      surface.tint = paint.tint;
      surface.cover = paint.cover;
      surface.light_step_m = paint.light_step_m;
      surfaces_.push_back(surface);
    }
  }
}

}  // namespace emulator::studio
