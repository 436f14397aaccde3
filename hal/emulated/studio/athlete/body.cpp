#include "hal/emulated/studio/athlete/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/emulated/studio/athlete/anatomy.h"
#include "hal/emulated/studio/athlete/skinning.h"
#include "hal/emulated/studio/athlete/surface_net.h"
#include "hal/emulated/studio/athlete/tailor.h"

namespace emulator::studio {
namespace {

/// Metres around the body's axis and up.
Eigen::Vector2f unrolled(const Point& p) {
  const float radius = std::hypot(p.x(), p.y());
  return {std::atan2(p.x(), p.y()) * radius, p.z()};
}

/// Joins @p surface to @p body; @p hidden says which vertices are never visible.
template <typename Hidden>
void join(Body& body, const Polygons& surface, const std::vector<Influence>& influences,
          Material material, Hidden hidden) {
  constexpr auto kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(surface.positions.size(), kNone);
  std::vector<char> unseen(surface.positions.size());
  for (std::size_t v = 0; v < unseen.size(); ++v) unseen[v] = hidden(surface.positions[v]) ? 1 : 0;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    const auto corners = std::span(surface.triangles).subspan(t, 3);
    if (std::ranges::all_of(corners, [&](auto v) { return unseen[v] != 0; })) continue;
    for (const auto v : corners) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(body.vertices.size());
        body.vertices.push_back(
            {surface.positions[v], surface.normals[v], unrolled(surface.positions[v]),
             static_cast<std::uint8_t>(material), influences[v].bones, influences[v].weights});
      }
      body.triangles.push_back(number[v]);
    }
  }
}

GridLines lines(float from, float to, float cell_m, double scale, std::vector<FineRange> fine) {
  const auto s = static_cast<float>(scale);
  for (auto& range : fine) range.cell_m *= s;
  return gridLines(from, to, cell_m * s, fine);
}

std::vector<Influence> rigid(std::size_t count, MidBone bone) {
  const Influence one{{static_cast<std::uint8_t>(boneIndex(bone)), 0, 0, 0}, {1, 0, 0, 0}};
  return std::vector<Influence>(count, one);
}

Polygons makeSphere(const Point& centre, float radius, int rings) {
  Polygons surface;
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    const float polar =
        std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(rings);
    for (int i = 0; i <= around; ++i) {
      const float azimuth =
          2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(around);
      const Point n{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                    std::cos(polar)};
      surface.positions.push_back(centre + n * radius);
      surface.normals.push_back(n);
    }
  }
  const auto at = [&](int j, int i) { return static_cast<std::uint32_t>(j * (around + 1) + i); };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      surface.triangles.insert(surface.triangles.end(), {at(j, i), at(j + 1, i), at(j + 1, i + 1),
                                                         at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return surface;
}

bool never(const Point& /*p*/) {
  return false;
}

}  // namespace

Body makeBody(const BodyShape& shape) {
  const Anatomy anatomy(shape);
  const Tailor tailor(shape, anatomy);
  const double scale = std::clamp(shape.cell_scale, 0.5, 4.0);

  Body body;
  body.shape = shape;
  body.bones.assign(restSkeleton().begin(), restSkeleton().end());

  // Fine where a face and two hands are.
  const auto skin = polygonise(
      [&](const Point& p) { return anatomy.skin(p); },
      lines(-1.0F, 1.0F, 0.011F, scale,
            {{-0.046F, 0.046F, 0.0028F},
             {-0.085F, 0.085F, 0.0045F},
             {0.66F, 0.92F, 0.0052F},
             {-0.92F, -0.66F, 0.0052F}}),
      lines(-0.22F, 0.26F, 0.011F, scale, {{-0.05F, 0.06F, 0.0052F}, {0.06F, 0.12F, 0.0030F}}),
      lines(-0.05F, 1.85F, 0.011F, scale,
            {{1.09F, 1.22F, 0.0055F},
             {1.57F, 1.72F, 0.0040F},
             {1.606F, 1.630F, 0.0025F},
             {1.636F, 1.650F, 0.0030F},
             {1.674F, 1.697F, 0.0022F}}));
  const auto skin_weights = skinInfluences(skin);
  const auto covered = [&](const Point& p) {
    return tailor.shirt(p) < -0.0035F || tailor.shorts(p) < -0.0035F || tailor.shoe(p) < -0.006F ||
           tailor.sole(p) < -0.004F || tailor.sock(p) < -0.002F;
  };
  join(body, skin, skin_weights, Material::kSkin, covered);

  const auto wear = [&](const Field& field, const GridLines& x, const GridLines& y,
                        const GridLines& z, Material material, int rounds, const auto& hidden) {
    const auto surface = polygonise(field, x, y, z);
    join(body, surface, clothInfluences(surface, skin, skin_weights, rounds), material, hidden);
  };
  wear([&](const Point& p) { return tailor.shirt(p); },
       lines(-0.5F, 0.5F, 0.0095F, scale, {{0.33F, 0.42F, 0.0055F}, {-0.42F, -0.33F, 0.0055F}}),
       lines(-0.25F, 0.25F, 0.0090F, scale, {}),
       lines(0.78F, 1.60F, 0.0095F, scale, {{0.825F, 0.85F, 0.0055F}, {1.47F, 1.54F, 0.0065F}}),
       Material::kShirt, 12, never);
  wear([&](const Point& p) { return tailor.shorts(p); }, lines(-0.32F, 0.32F, 0.0090F, scale, {}),
       lines(-0.25F, 0.25F, 0.0090F, scale, {}),
       lines(0.53F, 1.10F, 0.0095F, scale, {{0.59F, 0.615F, 0.0055F}}), Material::kShorts, 8,
       [&](const Point& p) { return tailor.shirt(p) < -0.012F; });
  const auto foot_x = lines(-0.22F, 0.22F, 0.0065F, scale, {});
  const auto foot_y = lines(-0.18F, 0.26F, 0.0065F, scale, {});
  wear([&](const Point& p) { return tailor.sock(p); }, foot_x, foot_y,
       lines(-0.03F, 0.26F, 0.0075F, scale, {}), Material::kSock, 1,
       [&](const Point& p) { return tailor.shoe(p) < -0.005F || tailor.sole(p) < -0.003F; });
  wear([&](const Point& p) { return tailor.shoe(p); }, foot_x, foot_y,
       lines(-0.03F, 0.20F, 0.0060F, scale, {}), Material::kShoe, 4,
       [&](const Point& p) { return tailor.sole(p) < -0.003F; });
  wear([&](const Point& p) { return tailor.sole(p); }, foot_x, foot_y,
       lines(-0.04F, 0.08F, 0.0060F, scale, {}), Material::kSole, 4, never);

  const auto hair = polygonise(
      [&](const Point& p) { return tailor.hair(p); }, lines(-0.16F, 0.16F, 0.0050F, scale, {}),
      lines(-0.24F, 0.16F, 0.0050F, scale, {}), lines(1.44F, 1.88F, 0.0050F, scale, {}));
  join(body, hair, rigid(hair.positions.size(), MidBone::kHead), Material::kHair,
       [&](const Point& p) { return anatomy.cranium(p) < -0.008F; });
  for (const float side : {1.0F, -1.0F}) {
    const Point centre{side * 0.0315F, 0.0765F, 1.6855F};
    const auto eye = makeSphere(centre, 0.0125F, 12);
    join(body, eye, rigid(eye.positions.size(), MidBone::kHead), Material::kEye,
         [](const Point& p) { return p.y() < 0.0765F; });
  }
  return body;
}

Body makeBall() {
  Body body;
  body.bones.assign(restSkeleton().begin(), restSkeleton().begin() + 1);
  const auto sphere = makeSphere(Point::Zero(), 1.0F, 24);
  join(body, sphere, rigid(sphere.positions.size(), MidBone::kPelvis), Material::kBall, never);
  return body;
}

}  // namespace emulator::studio
