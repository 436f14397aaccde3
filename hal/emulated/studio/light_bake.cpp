#include "hal/emulated/studio/light_bake.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <thread>

#include <Eigen/Geometry>

#include "hal/emulated/studio/random.h"
#include "hal/emulated/studio/ray_scene.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr std::uint32_t kSheetWidth = 2048;
constexpr int kLampSamples = 4;  // of a lamp near by; one of a lamp far away
constexpr float kNearLamp_m = 5.5f;
constexpr int kBounceRays = 24;
constexpr int kProbeRays = 400;
/// Stands for the second and all later bounces.
constexpr float kMoreBounces = 1.4f;
constexpr float kOffset_m = 0.004f;

/// Mean albedo of each cover, so that bounced light needs no texture.
Vector3f meanAlbedo(const Surface& surface) {
  switch (surface.cover) {
    case Cover::kFloor:
      return Vector3f(0.50f, 0.31f, 0.14f);
    case Cover::kBrick:
      return surface.tint.cwiseProduct(Vector3f::Constant(0.62f));
    case Cover::kPlank:
      return surface.tint.cwiseProduct(Vector3f(0.52f, 0.42f, 0.33f));
    case Cover::kPosters:
      return Vector3f(0.42f, 0.38f, 0.34f);
    case Cover::kNet:
    case Cover::kGlow:
      return Vector3f::Zero();
    default:
      return surface.tint * 0.62f;
  }
}

float luminance(const Vector3f& rgb) {
  return rgb.dot(Vector3f(0.2126f, 0.7152f, 0.0722f));
}

/// A direction about @p normal, as likely as a matt surface is bright from there.
Vector3f cosineDirection(const Vector3f& normal, float a, float b) {
  const float radius = std::sqrt(a);
  const float angle = 2 * std::numbers::pi_v<float> * b;
  const Vector3f across = normal.unitOrthogonal();
  return across * (radius * std::cos(angle)) + normal.cross(across) * (radius * std::sin(angle)) +
         normal * std::sqrt(1 - a);
}

class Baker {
 public:
  Baker(const std::vector<Surface>& surfaces, const std::vector<Lamp>& lamps)
      : surfaces_(surfaces), lamps_(lamps), rays_(surfaces) {}

  /// Irradiance over pi that the lamps from @p first on send to a point, and its swing.
  [[nodiscard]] Vector4f direct(const Vector3f& point, const Vector3f& normal, std::size_t first,
                                Random& random) const {
    Vector4f sum = Vector4f::Zero();
    for (std::size_t i = first; i < lamps_.size(); ++i) {
      const Lamp& lamp = lamps_[i];
      const Vector3f way = lamp.centre - point;
      const float reach = lamp.half_u.norm() + lamp.half_v.norm();
      if (way.dot(normal) < -reach || -way.dot(lamp.normal) < -reach) continue;
      const float area = 4 * lamp.half_u.norm() * lamp.half_v.norm();
      const int samples = way.norm() - reach < kNearLamp_m ? kLampSamples : 1;
      float seen = 0;
      for (int k = 0; k < samples; ++k) {
        const float u =
            2 * (static_cast<float>(k) + random.uniform(0, 1)) / static_cast<float>(samples) - 1;
        const Vector3f to = lamp.centre + lamp.half_u * u + lamp.half_v * random.uniform(-1, 1) +
                            lamp.normal * 0.02f;
        const Vector3f ray = to - point;
        const float square = ray.squaredNorm();
        const float cosines = ray.dot(normal) * -ray.dot(lamp.normal);
        if (ray.dot(normal) <= 0 || cosines <= 0 || rays_.blocked(point, to)) continue;
        seen += cosines / (square * square);
      }
      const Vector3f light =
          lamp.radiance * (seen * area / (static_cast<float>(samples) * std::numbers::pi_v<float>));
      sum.head<3>() += light;
      if (lamp.ripples) sum.w() += luminance(light) * (lamp.ripple(0) - 1);
    }
    return sum;
  }

  /// What the hall's surfaces send to a point, per @p light on them.
  [[nodiscard]] Vector4f bounced(const LightMap& map, const Vector3f& point, const Vector3f& normal,
                                 int count, Random& random) const {
    Vector4f sum = Vector4f::Zero();
    for (int k = 0; k < count; ++k) {
      const float stratum =
          (static_cast<float>(k) + random.uniform(0, 1)) / static_cast<float>(count);
      const auto hit =
          rays_.firstHit(point, cosineDirection(normal, stratum, random.uniform(0, 1)));
      if (!hit || !hit->front) continue;
      const LightMap::Place& place = map.places[hit->surface];
      const auto x =
          static_cast<std::uint32_t>(std::lround(hit->u * static_cast<float>(place.width - 1)));
      const auto y =
          static_cast<std::uint32_t>(std::lround(hit->v * static_cast<float>(place.height - 1)));
      const Vector4f& light = map.texels[std::size_t{place.y + y} * map.width + place.x + x];
      const Vector3f albedo = meanAlbedo(surfaces_[hit->surface]);
      sum.head<3>() += albedo.cwiseProduct(light.head<3>());
      sum.w() += luminance(albedo) * light.w();
    }
    return sum / static_cast<float>(count);
  }

 private:
  const std::vector<Surface>& surfaces_;
  const std::vector<Lamp>& lamps_;
  RayScene rays_;
};

/// Shelves of places, the tallest first.
LightMap layOut(const std::vector<Surface>& surfaces) {
  LightMap map;
  map.width = kSheetWidth;
  for (const Surface& s : surfaces) {
    const auto texels = [&](float metres) {
      const float steps = std::ceil(metres / s.light_step_m);
      return static_cast<std::uint32_t>(std::clamp(steps, 1.0f, 500.0f)) + 1;
    };
    const float width =
        std::max((s.corners[1] - s.corners[0]).norm(), (s.corners[3] - s.corners[2]).norm());
    const float height =
        std::max((s.corners[2] - s.corners[0]).norm(), (s.corners[3] - s.corners[1]).norm());
    map.places.push_back({.width = texels(width), .height = texels(height)});
  }
  std::vector<std::size_t> order(surfaces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::size_t i) { return map.places[i].height; });
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t shelf = 0;
  for (const std::size_t i : order) {
    LightMap::Place& place = map.places[i];
    if (x + place.width > map.width) {
      x = 0;
      y += shelf;
      shelf = 0;
    }
    place.x = x;
    place.y = y;
    x += place.width;
    shelf = std::max(shelf, place.height);
  }
  map.height = y + shelf;
  map.texels.assign(std::size_t{map.width} * map.height, Vector4f::Zero());
  return map;
}

/// Calls work(i) for all i below count, on every core.
void onEveryCore(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k) {
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
}

/// Rays scatter; the light that they gather far away is smooth.
void smooth(LightMap& map, const LightMap::Place& place, int reach) {
  const std::vector<Vector4f> before = [&] {
    std::vector<Vector4f> copy;
    for (std::uint32_t y = 0; y < place.height; ++y) {
      const auto row = map.texels.begin() +
                       static_cast<std::ptrdiff_t>(std::size_t{place.y + y} * map.width + place.x);
      copy.insert(copy.end(), row, row + place.width);
    }
    return copy;
  }();
  const auto width = static_cast<int>(place.width);
  const auto height = static_cast<int>(place.height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Vector4f sum = Vector4f::Zero();
      float weights = 0;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
          sum += before[static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x + dx)];
          weights += 1;
        }
      }
      map.texels[(place.y + static_cast<std::size_t>(y)) * map.width + place.x +
                 static_cast<std::size_t>(x)] = sum / weights;
    }
  }
}

}  // namespace

Vector2f LightProbes::positionOf(std::uint32_t column, std::uint32_t row) {
  return {-6.0f + 3.0f * static_cast<float>(column), -3.0f + 3.0f * static_cast<float>(row)};
}

LightProbes::Cube LightProbes::at(const Vector2f& place) const {
  const float x = std::clamp((place.x() + 6) / 3, 0.0f, kColumns - 1.001f);
  const float y = std::clamp((place.y() + 3) / 3, 0.0f, kRows - 1.001f);
  const auto column = static_cast<std::uint32_t>(x);
  const auto row = static_cast<std::uint32_t>(y);
  const float u = x - static_cast<float>(column);
  const float v = y - static_cast<float>(row);
  Cube cube;
  for (std::size_t side = 0; side < cube.size(); ++side) {
    const auto& c = cubes;
    const std::size_t i = std::size_t{row} * kColumns + column;
    cube[side] = (c[i][side] * (1 - u) + c[i + 1][side] * u) * (1 - v) +
                 (c[i + kColumns][side] * (1 - u) + c[i + kColumns + 1][side] * u) * v;
  }
  return cube;
}

BakedLight bakeLight(const std::vector<Surface>& surfaces, const std::vector<Lamp>& lamps,
                     const std::function<void(double)>& progress) {
  const Baker baker(surfaces, lamps);
  BakedLight baked{.map = layOut(surfaces), .probes = {}};
  LightMap& map = baked.map;
  LightMap second = map;

  // Rows of texels are the unit of work, so that the floor does not keep one core busy alone.
  struct Row {
    std::uint32_t surface;
    std::uint32_t y;
  };
  std::vector<Row> rows;
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].cover == Cover::kGlow) continue;
    for (std::uint32_t y = 0; y < map.places[i].height; ++y) rows.push_back({i, y});
  }
  std::atomic<std::size_t> done = 0;
  const auto report = [&] {
    if (const std::size_t n = ++done; n % 512 == 0)
      progress(static_cast<double>(n) / static_cast<double>(2 * rows.size()));
  };
  const auto eachTexel = [&](LightMap& to, const Row& row, auto light) {
    const LightMap::Place& place = map.places[row.surface];
    const Surface& surface = surfaces[row.surface];
    Random random((std::uint64_t{row.surface} << 20) + row.y);
    for (std::uint32_t x = 0; x < place.width; ++x) {
      // A little inside: on the very edge the neighbour's wall would be in the way.
      const auto inside = [](std::uint32_t i, std::uint32_t n) {
        return std::clamp(static_cast<float>(i) / static_cast<float>(n - 1), 0.02f, 0.98f);
      };
      const float u = inside(x, place.width);
      const float v = inside(row.y, place.height);
      const Vector3f normal = surface.normalAt(u, v);
      to.texels[std::size_t{place.y + row.y} * map.width + place.x + x] =
          light(Vector3f(surface.at(u, v) + normal * kOffset_m), normal, random);
    }
    report();
  };
  onEveryCore(rows.size(), [&](std::size_t i) {
    eachTexel(map, rows[i], [&](const Vector3f& point, const Vector3f& normal, Random& random) {
      return baker.direct(point, normal, 0, random);
    });
  });
  onEveryCore(rows.size(), [&](std::size_t i) {
    eachTexel(second, rows[i],
              [&](const Vector3f& point, const Vector3f& normal, Random& random) -> Vector4f {
                return baker.bounced(map, point, normal, kBounceRays, random) * kMoreBounces;
              });
  });
  onEveryCore(surfaces.size(), [&](std::size_t i) { smooth(second, second.places[i], 2); });
  onEveryCore(surfaces.size(), [&](std::size_t i) { smooth(map, map.places[i], 1); });
  for (std::size_t i = 0; i < map.texels.size(); ++i) map.texels[i] += second.texels[i];

  onEveryCore(baked.probes.cubes.size(), [&](std::size_t i) {
    const auto column = static_cast<std::uint32_t>(i % LightProbes::kColumns);
    const auto row = static_cast<std::uint32_t>(i / LightProbes::kColumns);
    Random random(0xbeef + i);
    const Vector2f place = LightProbes::positionOf(column, row);
    const Vector3f point(place.x(), place.y(), 1.0f);
    for (std::size_t side = 0; side < 6; ++side) {
      Vector3f normal = Vector3f::Zero();
      normal[static_cast<Eigen::Index>(side / 2)] = side % 2 == 0 ? 1.0f : -1.0f;
      const Vector4f light = baker.direct(point, normal, kKeyLamps, random) +
                             baker.bounced(map, point, normal, kProbeRays, random);
      baked.probes.cubes[i][side] = light.head<3>();
    }
  });
  return baked;
}

cv::Mat floorLight(const std::vector<Surface>& surfaces, const LightMap& map) {
  const auto floor = std::ranges::find(surfaces, Cover::kFloor, &Surface::cover);
  const LightMap::Place& place = map.places[static_cast<std::size_t>(floor - surfaces.begin())];
  cv::Mat light(static_cast<int>(place.height), static_cast<int>(place.width), CV_32F);
  for (std::uint32_t y = 0; y < place.height; ++y) {
    for (std::uint32_t x = 0; x < place.width; ++x) {
      const Eigen::Vector4f& t = map.texels[std::size_t{place.y + y} * map.width + place.x + x];
      light.at<float>(static_cast<int>(y), static_cast<int>(x)) =
          0.2126f * t.x() + 0.7152f * t.y() + 0.0722f * t.z();
    }
  }
  return light;
}

}  // namespace emulator::studio
