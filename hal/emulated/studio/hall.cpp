#include "hal/emulated/studio/hall.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "hal/emulated/studio/hall_size.h"
#include "hal/emulated/studio/lamps.h"
#include "hal/emulated/studio/posters.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Paint = SurfaceBuilder::Paint;

constexpr float kWidth = kHallRight_m - kHallLeft_m;
constexpr float kDepth = kHallBack_m - kHallFront_m;

const Paint kWood{
    .cover = Cover::kWood, .tint = {0.95f, 0.78f, 0.56f}, .tile_m = 0.9f, .light_step_m = 0.12f};
const Paint kDarkWood{
    .cover = Cover::kWood, .tint = {0.52f, 0.33f, 0.19f}, .tile_m = 0.8f, .light_step_m = 0.12f};
const Paint kSteel{
    .cover = Cover::kMetal, .tint = {0.46f, 0.48f, 0.50f}, .tile_m = 0.7f, .light_step_m = 0.15f};
const Paint kDarkSteel{
    .cover = Cover::kMetal, .tint = {0.11f, 0.12f, 0.13f}, .tile_m = 0.7f, .light_step_m = 0.15f};
const Paint kWhiteSteel{
    .cover = Cover::kMetal, .tint = {0.86f, 0.87f, 0.86f}, .tile_m = 0.7f, .light_step_m = 0.15f};

Paint vinyl(const Vector3f& tint) {
  return {.cover = Cover::kVinyl, .tint = tint, .tile_m = 0.8f, .light_step_m = 0.08f};
}

void buildShell(SurfaceBuilder& hall) {
  const Vector3f low(kHallLeft_m, kHallFront_m, 0);
  hall.picture(low, {kWidth, 0, 0}, {0, kDepth, 0}, {.cover = Cover::kFloor, .light_step_m = 0.09f},
               {0, 0}, {1, 1});
  hall.sheet({kHallLeft_m, kHallBack_m, kHallHeight_m}, {kWidth, 0, 0}, {0, -kDepth, 0},
             {.cover = Cover::kCeiling, .tile_m = 2.4f, .light_step_m = 0.3f});
  constexpr float kBrickTop = 3.1f;
  // Back wall: painted brick, plaster above, a wooden rail between.
  hall.sheet({kHallLeft_m, kHallBack_m, 0}, {kWidth, 0, 0}, {0, 0, kBrickTop},
             {.cover = Cover::kBrick, .tint = {0.93f, 0.89f, 0.80f}, .tile_m = 4.0f});
  hall.sheet({kHallLeft_m, kHallBack_m, kBrickTop}, {kWidth, 0, 0},
             {0, 0, kHallHeight_m - kBrickTop},
             {.cover = Cover::kPlaster,
              .tint = {0.88f, 0.90f, 0.86f},
              .tile_m = 4.0f,
              .light_step_m = 0.15f});
  // Side walls: planks, plaster above.
  constexpr float kPlankTop = 2.5f;
  const Paint planks{.cover = Cover::kPlank, .tint = {0.98f, 0.86f, 0.68f}, .tile_m = 3.0f};
  const Paint plaster{.cover = Cover::kPlaster,
                      .tint = {0.92f, 0.90f, 0.83f},
                      .tile_m = 4.0f,
                      .light_step_m = 0.15f};
  hall.sheet({kHallLeft_m, kHallFront_m, 0}, {0, kDepth, 0}, {0, 0, kPlankTop}, planks);
  hall.sheet({kHallLeft_m, kHallFront_m, kPlankTop}, {0, kDepth, 0},
             {0, 0, kHallHeight_m - kPlankTop}, plaster);
  hall.sheet({kHallRight_m, kHallBack_m, 0}, {0, -kDepth, 0}, {0, 0, kPlankTop}, planks);
  hall.sheet({kHallRight_m, kHallBack_m, kPlankTop}, {0, -kDepth, 0},
             {0, 0, kHallHeight_m - kPlankTop}, plaster);
  // Behind the cameras.
  hall.sheet({kHallRight_m, kHallFront_m, 0}, {-kWidth, 0, 0}, {0, 0, kHallHeight_m}, plaster);
  // Skirting and rails.
  hall.box({0, kHallBack_m - 0.015f, 0.06f}, {kWidth, 0.03f, 0.12f}, 0, kDarkWood);
  hall.box({0, kHallBack_m - 0.03f, kBrickTop}, {kWidth, 0.06f, 0.16f}, 0, kWood);
  for (const float x : {kHallLeft_m + 0.02f, kHallRight_m - 0.02f}) {
    hall.box({x, -0.5f, kPlankTop}, {0.05f, kDepth, 0.12f}, 0, kDarkWood);
    hall.box({x, -0.5f, 0.06f}, {0.03f, kDepth, 0.12f}, 0, kDarkWood);
  }
}

void buildCeiling(SurfaceBuilder& hall, std::uint64_t seed) {
  const Paint beam{
      .cover = Cover::kWood, .tint = {0.80f, 0.62f, 0.42f}, .tile_m = 1.6f, .light_step_m = 0.3f};
  for (float x = kHallLeft_m + 2.1f; x < kHallRight_m; x += 4.2f) {
    hall.box({x, -0.5f, kHallHeight_m - 0.28f}, {0.22f, kDepth, 0.56f}, 0, beam);
  }
  for (const Lamp& lamp : hallLamps(seed)) {
    if (!lamp.ripples) {  // window panes between mullions
      const Paint glow{.cover = Cover::kGlow, .tint = lamp.radiance, .light_step_m = 1};
      constexpr int kPanes = 10;
      const float step = 2 * lamp.half_u.y() / kPanes;
      for (int i = 0; i < kPanes; ++i) {
        const float y = lamp.centre.y() + lamp.half_u.y() - step * static_cast<float>(i);
        hall.sheet({kHallRight_m - 0.03f, y - 0.05f, lamp.centre.z() - lamp.half_v.z()},
                   {0, -(step - 0.10f), 0}, {0, 0, 2 * lamp.half_v.z()}, glow);
        hall.box({kHallRight_m - 0.04f, y, lamp.centre.z()}, {0.09f, 0.09f, 1.5f}, 0, kWhiteSteel);
      }
      for (const float side : {-1.0f, 1.0f}) {
        hall.box({kHallRight_m - 0.04f, lamp.centre.y(), lamp.centre.z() + side * 0.70f},
                 {0.10f, 13.1f, 0.10f}, 0, kWhiteSteel);
      }
      continue;
    }
    const Vector3f size(2 * lamp.half_u.x(), 2 * lamp.half_v.y(), 0.10f);
    hall.box(lamp.centre + Vector3f(0, 0, 0.065f), size + Vector3f(0.06f, 0.06f, 0), 0,
             kWhiteSteel);
    hall.sheet(lamp.centre + Vector3f(-size.x() / 2, size.y() / 2, 0.01f), {size.x(), 0, 0},
               {0, -size.y(), 0},
               {.cover = Cover::kGlow, .tint = lamp.radiance * 0.2f, .light_step_m = 1});
    for (const float side : {-0.6f, 0.6f}) {
      hall.bar(lamp.centre + Vector3f(side, 0, 0.1f), lamp.centre + Vector3f(side, 0, 0.5f), 0.008f,
               4, kDarkSteel);
    }
  }
}

void buildWallBars(SurfaceBuilder& hall, float x, float width) {
  const float y = kHallBack_m - 0.14f;
  for (const float side : {0.0f, 1.0f}) {
    hall.box({x + side * width, y, 1.3f}, {0.05f, 0.16f, 2.6f}, 0, kWood);
  }
  for (int i = 0; i < 16; ++i) {
    const float z = 0.18f + 0.155f * static_cast<float>(i);
    hall.bar({x, y - 0.03f, z}, {x + width, y - 0.03f, z}, 0.019f, 6, kWood);
  }
}

void buildBench(SurfaceBuilder& hall, const Vector3f& centre, float length, float turn) {
  const Eigen::AngleAxisf rotation(turn, Vector3f::UnitZ());
  const auto at = [&](float x, float y, float z) -> Vector3f {
    return centre + rotation * Vector3f(x, y, z);
  };
  hall.box(at(0, 0, 0.335f), {length, 0.25f, 0.035f}, turn, kWood);
  hall.box(at(0, 0, 0.12f), {length, 0.10f, 0.05f}, turn, kWood);
  for (const float side : {-0.38f, 0.0f, 0.38f}) {
    hall.box(at(side * length, 0, 0.165f), {0.05f, 0.22f, 0.31f}, turn, kDarkWood);
  }
}

void buildGoal(SurfaceBuilder& hall, const Vector3f& foot, float turn) {
  // Handball: 3 m by 2 m inside, 8 cm square posts in red and white.
  const Eigen::AngleAxisf rotation(turn, Vector3f::UnitZ());
  const auto at = [&](float x, float y, float z) -> Vector3f {
    return foot + rotation * Vector3f(x, y, z);
  };
  const auto stripe = [](int i) {
    return Paint{.cover = Cover::kMetal,
                 .tint = i % 2 == 0 ? Vector3f(0.72f, 0.07f, 0.06f) : Vector3f(0.88f, 0.87f, 0.84f),
                 .tile_m = 0.7f,
                 .light_step_m = 0.1f};
  };
  for (int i = 0; i < 10; ++i) {
    const float z = 0.104f + 0.208f * static_cast<float>(i);
    for (const float side : {-1.54f, 1.54f})
      hall.box(at(side, 0, z), {0.08f, 0.08f, 0.208f}, turn, stripe(i));
  }
  for (int i = 0; i < 15; ++i) {
    const float x = -1.4f + 0.2f * static_cast<float>(i);
    hall.box(at(x, 0, 2.04f), {0.2f, 0.08f, 0.08f}, turn, stripe(i + 1));
  }
  for (const float side : {-1.54f, 1.54f}) {
    hall.bar(at(side, 0, 2.04f), at(side, 0.8f, 2.0f), 0.018f, 6, kSteel);
    hall.bar(at(side, 0.8f, 2.0f), at(side, 1.0f, 0.03f), 0.018f, 6, kSteel);
    hall.bar(at(side, 0, 0.03f), at(side, 1.0f, 0.03f), 0.018f, 6, kSteel);
  }
  hall.bar(at(-1.54f, 1.0f, 0.03f), at(1.54f, 1.0f, 0.03f), 0.018f, 6, kSteel);
  hall.bar(at(-1.54f, 0.8f, 2.0f), at(1.54f, 0.8f, 2.0f), 0.018f, 6, kSteel);
  const Paint net{
      .cover = Cover::kNet, .tint = {0.85f, 0.86f, 0.84f}, .tile_m = 0.5f, .light_step_m = 0.2f};
  hall.sheet(at(-1.54f, 1.0f, 0.03f), rotation * Vector3f(3.08f, 0, 0),
             rotation * Vector3f(0, -0.2f, 1.97f), net);
  hall.sheet(at(-1.54f, 0.02f, 2.03f), rotation * Vector3f(3.08f, 0, 0),
             rotation * Vector3f(0, 0.8f, -0.02f), net);
  for (const float side : {-1.54f, 1.54f}) {
    hall.sheet(at(side, 0.02f, 0.03f), rotation * Vector3f(0, 0.92f, 0),
               rotation * Vector3f(0, 0, 1.98f), net);
  }
}

void buildBasket(SurfaceBuilder& hall, float x) {
  const float wall = kHallBack_m;
  const float y = wall - 0.9f;
  hall.box({x, y, 3.42f}, {1.8f, 0.04f, 1.05f}, 0,
           {.cover = Cover::kPlaster,
            .tint = {0.92f, 0.92f, 0.90f},
            .tile_m = 2,
            .light_step_m = 0.08f});
  const Paint line = vinyl({0.72f, 0.12f, 0.06f});
  const auto frame = [&](float half_x, float low_z, float high_z) {
    const float front = y - 0.024f;
    for (const float side : {-half_x, half_x})
      hall.box({x + side, front, (low_z + high_z) / 2}, {0.05f, 0.006f, high_z - low_z + 0.05f}, 0,
               line);
    for (const float z : {low_z, high_z})
      hall.box({x, front, z}, {2 * half_x - 0.05f, 0.006f, 0.05f}, 0, line);
  };
  frame(0.86f, 2.93f, 3.91f);
  frame(0.27f, 3.10f, 3.52f);
  for (const float side : {-0.5f, 0.5f}) {
    for (const float z : {3.1f, 3.8f})
      hall.bar({x + side, wall, z}, {x + side, y + 0.02f, z}, 0.025f, 6, kSteel);
    hall.bar({x + side, wall, 3.8f}, {x + side, y + 0.02f, 3.1f}, 0.018f, 6, kSteel);
  }
  const Paint ring{
      .cover = Cover::kMetal, .tint = {0.85f, 0.23f, 0.04f}, .tile_m = 0.7f, .light_step_m = 0.1f};
  const Paint cord{
      .cover = Cover::kMetal, .tint = {0.88f, 0.87f, 0.84f}, .tile_m = 0.5f, .light_step_m = 0.2f};
  constexpr int kSides = 16;
  const auto on = [&](float angle, float radius, float z) -> Vector3f {
    return {x + radius * std::cos(angle), y - 0.40f + radius * std::sin(angle), z};
  };
  for (int i = 0; i < kSides; ++i) {
    const float a = 6.2831853f * static_cast<float>(i) / kSides;
    const float b = 6.2831853f * static_cast<float>(i + 1) / kSides;
    hall.bar(on(a, 0.23f, 3.05f), on(b, 0.23f, 3.05f), 0.010f, 5, ring);
    hall.bar(on(a, 0.23f, 3.05f), on(b, 0.17f, 2.82f), 0.004f, 3, cord);
    hall.bar(on(b, 0.23f, 3.05f), on(a, 0.17f, 2.82f), 0.004f, 3, cord);
    hall.bar(on(a, 0.17f, 2.82f), on(b, 0.15f, 2.62f), 0.004f, 3, cord);
    hall.bar(on(b, 0.17f, 2.82f), on(a, 0.15f, 2.62f), 0.004f, 3, cord);
  }
}

void buildVaultingBox(SurfaceBuilder& hall, const Vector3f& foot, float turn) {
  for (int i = 0; i < 4; ++i) {
    const float shrink = 0.04f * static_cast<float>(i);
    hall.box(foot + Vector3f(0, 0, 0.11f + 0.205f * static_cast<float>(i)),
             {1.45f - shrink, 0.60f - shrink, 0.20f}, turn, kWood);
  }
  hall.box(foot + Vector3f(0, 0, 0.91f), {1.30f, 0.46f, 0.17f}, turn, vinyl({0.36f, 0.22f, 0.11f}));
}

void buildMats(SurfaceBuilder& hall, Random& random) {
  // A trolley with blue mats, each laid a little askew.
  const Vector3f foot(6.6f, 5.9f, 0);
  hall.box(foot + Vector3f(0, 0, 0.16f), {2.05f, 1.05f, 0.05f}, 0.04f, kSteel);
  for (const float x : {-0.85f, 0.85f}) {
    for (const float y : {-0.4f, 0.4f})
      hall.bar(foot + Vector3f(x, y - 0.02f, 0.07f), foot + Vector3f(x, y + 0.02f, 0.07f), 0.065f,
               10, kDarkSteel);
  }
  for (int i = 0; i < 7; ++i) {
    const float z = 0.225f + 0.068f * static_cast<float>(i);
    const Vector3f tint = i == 4 ? Vector3f(0.10f, 0.36f, 0.20f)
                                 : Vector3f(0.06f, 0.17f, 0.45f) * random.uniform(0.8f, 1.2f);
    hall.box(foot + Vector3f(random.uniform(-0.04f, 0.04f), random.uniform(-0.03f, 0.03f), z),
             {2.0f, 1.0f, 0.064f}, 0.04f + random.uniform(-0.03f, 0.03f), vinyl(tint));
  }
  // A thick one leans on the left wall; Surface by surface because it is tilted.
  const Vector3f corner(kHallLeft_m + 0.75f, 1.0f, 0.01f);
  const Vector3f along(0, 2.6f, 0);
  const Vector3f up(-0.45f, 0, 1.75f);
  const Vector3f thick = up.normalized().cross(along.normalized()) * 0.28f;
  const Paint soft = vinyl({0.07f, 0.19f, 0.43f});
  const Paint edge = vinyl({0.75f, 0.74f, 0.70f});
  hall.sheet(corner, along, up, soft);
  hall.sheet(corner + thick, up, along, soft);
  hall.sheet(corner, thick, along, edge);
  hall.sheet(corner + up, along, thick, edge);
  hall.sheet(corner, up, thick, edge);
  hall.sheet(corner + along, thick, up, edge);
}

void buildBalls(SurfaceBuilder& hall, Random& random) {
  const std::array<Vector3f, 5> tints = {
      Vector3f(0.80f, 0.30f, 0.08f), Vector3f(0.82f, 0.78f, 0.20f), Vector3f(0.12f, 0.30f, 0.62f),
      Vector3f(0.80f, 0.80f, 0.78f), Vector3f(0.65f, 0.10f, 0.12f)};
  const auto ballPaint = [&] {
    return Paint{.cover = Cover::kBallSkin,
                 .tint = tints[random.next() % tints.size()],
                 .tile_m = 1,
                 .light_step_m = 0.06f};
  };
  // A rack of tubes with three rows of balls.
  const Vector3f foot(-6.3f, 5.6f, 0);
  for (int row = 0; row < 3; ++row) {
    const float z = 0.30f + 0.38f * static_cast<float>(row);
    for (const float y : {-0.09f, 0.09f})
      hall.bar(foot + Vector3f(-0.75f, y, z), foot + Vector3f(0.75f, y, z), 0.014f, 6, kSteel);
    for (int i = 0; i < 6; ++i) {
      if (random.unit() < 0.15) continue;
      const float radius = random.uniform(0.090f, 0.118f);
      hall.ball(foot + Vector3f(-0.63f + 0.252f * static_cast<float>(i), 0,
                                z + std::sqrt((radius + 0.014f) * (radius + 0.014f) - 0.0081f)),
                radius, ballPaint());
    }
  }
  for (const float x : {-0.76f, 0.76f}) {
    for (const float y : {-0.12f, 0.12f})
      hall.bar(foot + Vector3f(x, y, 0.02f), foot + Vector3f(x, y, 1.3f), 0.016f, 6, kDarkSteel);
  }
  // Some that rolled away.
  const std::array<Vector2f, 5> places = {Vector2f(-3.6f, 6.6f), Vector2f(4.7f, 4.3f),
                                          Vector2f(-8.3f, 0.2f), Vector2f(8.6f, 2.4f),
                                          Vector2f(-4.4f, 4.1f)};
  for (const Vector2f& place : places) {
    const float radius = random.uniform(0.092f, 0.12f);
    hall.ball(
        {place.x() + random.uniform(-0.4f, 0.4f), place.y() + random.uniform(-0.4f, 0.4f), radius},
        radius, ballPaint());
  }
}

void buildSmallThings(SurfaceBuilder& hall, Random& random) {
  // Training cones on the free floor.
  for (int i = 0; i < 9; ++i) {
    const float x = -4.8f + 1.2f * static_cast<float>(i) + random.uniform(-0.06f, 0.06f);
    const Vector3f foot(x, 3.55f + random.uniform(-0.05f, 0.05f), 0);
    const Paint cone =
        vinyl(i % 3 == 0 ? Vector3f(0.85f, 0.62f, 0.05f) : Vector3f(0.86f, 0.23f, 0.03f));
    constexpr int kRings = 5;
    constexpr float kRing = 0.022f;
    for (int ring = 0; ring < kRings; ++ring) {
      const float z = kRing * static_cast<float>(ring);
      const float radius = ring == 0 ? 0.105f : 0.090f - 0.014f * static_cast<float>(ring);
      hall.bar(foot + Vector3f(0, 0, z), foot + Vector3f(0, 0, z + kRing), radius, 10, cone);
    }
  }
  // Bags and bottles at the benches.
  hall.box({-1.9f, 6.72f, 0.47f}, {0.52f, 0.24f, 0.24f}, 0.15f, vinyl({0.05f, 0.06f, 0.08f}));
  hall.box({-1.9f, 6.59f, 0.47f}, {0.30f, 0.012f, 0.07f}, 0.15f, vinyl({0.75f, 0.75f, 0.72f}));
  hall.box({-2.9f, 6.42f, 0.15f}, {0.56f, 0.28f, 0.30f}, -0.2f, vinyl({0.55f, 0.06f, 0.09f}));
  hall.box({8.15f, 4.2f, 0.16f}, {0.30f, 0.6f, 0.32f}, 0.25f, vinyl({0.07f, 0.25f, 0.14f}));
  for (int i = 0; i < 6; ++i) {
    const Vector3f foot(-1.35f + 0.17f * static_cast<float>(i) + random.uniform(-0.04f, 0.04f),
                        6.75f + random.uniform(-0.06f, 0.06f), 0.353f);
    const Paint bottle =
        vinyl(i % 2 == 0 ? Vector3f(0.10f, 0.40f, 0.65f) : Vector3f(0.70f, 0.72f, 0.70f));
    hall.bar(foot, foot + Vector3f(0, 0, 0.19f), 0.034f, 10, bottle);
    hall.bar(foot + Vector3f(0, 0, 0.19f), foot + Vector3f(0, 0, 0.235f), 0.015f, 8,
             vinyl({0.05f, 0.05f, 0.06f}));
  }
  hall.box({-0.1f, 6.72f, 0.36f}, {0.42f, 0.26f, 0.02f}, 0.3f,
           vinyl({0.78f, 0.50f, 0.12f}));  // a towel
  hall.box({-0.05f, 6.592f, 0.26f}, {0.38f, 0.012f, 0.2f}, 0.06f, vinyl({0.78f, 0.50f, 0.12f}));
  // Fire extinguisher, radiators, loudspeakers.
  hall.bar({9.4f, kHallBack_m - 0.1f, 0.75f}, {9.4f, kHallBack_m - 0.1f, 1.2f}, 0.085f, 12,
           vinyl({0.72f, 0.03f, 0.03f}));
  hall.bar({9.4f, kHallBack_m - 0.1f, 1.2f}, {9.4f, kHallBack_m - 0.1f, 1.3f}, 0.03f, 8,
           kDarkSteel);
  for (int i = 0; i < 14; ++i) {
    hall.box({kHallLeft_m + 0.08f, -3.6f + 0.11f * static_cast<float>(i), 0.5f},
             {0.12f, 0.07f, 0.7f}, 0, kWhiteSteel);
    hall.box({kHallRight_m - 0.08f, 1.6f + 0.11f * static_cast<float>(i), 0.5f},
             {0.12f, 0.07f, 0.7f}, 0, kWhiteSteel);
  }
  for (const float x : {-9.6f, 9.6f})
    hall.box({x, kHallBack_m - 0.2f, 4.6f}, {0.36f, 0.32f, 0.6f}, 0, kDarkSteel);
}

void buildDoor(SurfaceBuilder& hall, float x) {
  const float y = kHallBack_m;
  hall.box({x, y - 0.02f, 1.06f}, {1.96f, 0.05f, 2.12f}, 0, kDarkSteel);
  for (const float side : {-0.47f, 0.47f}) {
    hall.box({x + side, y - 0.05f, 1.03f}, {0.91f, 0.04f, 2.04f}, 0,
             {.cover = Cover::kWood,
              .tint = {0.30f, 0.42f, 0.46f},
              .tile_m = 2.2f,
              .light_step_m = 0.1f});
    hall.box({x + side, y - 0.074f, 1.55f}, {0.34f, 0.01f, 0.5f}, 0,
             {.cover = Cover::kMetal,
              .tint = {0.09f, 0.11f, 0.12f},
              .tile_m = 1,
              .light_step_m = 0.15f});
    hall.bar({x + side * 0.2f, y - 0.12f, 0.85f}, {x + side * 0.2f, y - 0.12f, 1.25f}, 0.014f, 6,
             kSteel);
  }
  hall.box({x, y - 0.06f, 2.36f}, {0.46f, 0.05f, 0.2f}, 0, kWhiteSteel);
  hall.sheet({x - 0.2f, y - 0.087f, 2.28f}, {0.4f, 0, 0}, {0, 0, 0.16f},
             {.cover = Cover::kGlow, .tint = {0.03f, 0.55f, 0.20f}, .light_step_m = 1});
}

void hangPosters(SurfaceBuilder& hall) {
  const Paint paper{.cover = Cover::kPosters, .light_step_m = 0.12f};
  for (const HungPoster& poster : hungPosters()) {
    const PosterPlace place = posterPlace(poster.poster);
    const float width = poster.height_m * place.aspect;
    const Vector3f along = poster.wall == Wall::kBack   ? Vector3f(width, 0, 0)
                           : poster.wall == Wall::kLeft ? Vector3f(0, width, 0)
                                                        : Vector3f(0, -width, 0);
    const Vector3f foot =
        poster.wall == Wall::kBack
            ? Vector3f(poster.along_m - width / 2, kHallBack_m - 0.012f, poster.low_m)
        : poster.wall == Wall::kLeft
            ? Vector3f(kHallLeft_m + 0.012f, poster.along_m - width / 2, poster.low_m)
            : Vector3f(kHallRight_m - 0.012f, poster.along_m + width / 2, poster.low_m);
    hall.picture(foot, along, {0, 0, poster.height_m}, paper, place.low, place.high);
  }
}

}  // namespace

std::vector<Surface> buildHall(std::uint64_t seed) {
  Random random(seed ^ 0x4a11);
  SurfaceBuilder hall;
  buildShell(hall);
  buildCeiling(hall, seed);
  buildWallBars(hall, -6.9f, 0.92f);
  buildWallBars(hall, -5.95f, 0.92f);
  buildWallBars(hall, -5.0f, 0.92f);
  buildWallBars(hall, 6.4f, 0.92f);
  buildBench(hall, {-1.4f, 6.72f, 0}, 3.6f, 0);
  buildBench(hall, {8.5f, 4.1f, 0}, 3.0f, 1.45f);
  buildBench(hall, {-9.2f, -2.0f, 0}, 3.6f, 1.57f);
  buildGoal(hall, {3.1f, 5.8f, 0}, 0.06f);
  buildBasket(hall, 0.35f);
  buildVaultingBox(hall, {-8.3f, 4.3f, 0}, 0.5f);
  buildMats(hall, random);
  buildBalls(hall, random);
  buildSmallThings(hall, random);
  buildDoor(hall, -8.7f);
  hangPosters(hall);
  return hall.take();
}

}  // namespace emulator::studio
