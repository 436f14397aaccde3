#include <gtest/gtest.h>

#include "hal/emulated/studio/hall.h"
#include "hal/emulated/studio/lamps.h"
#include "hal/emulated/studio/light_bake.h"
#include "hal/emulated/studio/ray_scene.h"

namespace {

using emulator::studio::BakedLight;
using emulator::studio::bakeLight;
using emulator::studio::buildHall;
using emulator::studio::Cover;
using emulator::studio::hallLamps;
using emulator::studio::Lamp;
using emulator::studio::RayScene;
using emulator::studio::Surface;
using emulator::studio::SurfaceBuilder;

TEST(StudioRays, MeetTheNearerOfTwoSheetsFromItsFront) {
  SurfaceBuilder builder;
  builder.sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {});
  builder.sheet({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, {});
  const RayScene rays(builder.take());
  const auto hit = rays.firstHit({0.5f, 0, 3}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->surface, 1u);
  EXPECT_TRUE(hit->front);
  EXPECT_NEAR(hit->distance, 2, 1e-5);
  EXPECT_NEAR(hit->u, 0.75, 1e-5);
  EXPECT_TRUE(rays.blocked({0, 0, 3}, {0, 0, 0.5f}));
  EXPECT_FALSE(rays.blocked({0, 0, 3}, {0, 0, 1.5f}));
  EXPECT_FALSE(rays.firstHit({5, 0, 3}, {0, 0, -1}));
}

TEST(StudioLight, IsDarkUnderATableAndBrightBesideIt) {
  SurfaceBuilder builder;
  builder.sheet({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, {.light_step_m = 0.25f});
  builder.box({-1.5f, 0, 0.5f}, {1, 1, 0.05f}, 0, {.light_step_m = 0.5f});
  const auto surfaces = builder.take();
  Lamp lamp;
  lamp.centre = {0, 0, 4};
  lamp.half_u = {0.3f, 0, 0};
  lamp.half_v = {0, 0.3f, 0};
  lamp.normal = {0, 0, -1};
  lamp.radiance = {10, 10, 10};
  const BakedLight light = bakeLight(surfaces, {lamp}, [](double) {});
  const auto& place = light.map.places[0];
  const auto at = [&](float u, float v) {
    const auto x = static_cast<std::uint32_t>(u * static_cast<float>(place.width - 1));
    const auto y = static_cast<std::uint32_t>(v * static_cast<float>(place.height - 1));
    return light.map.texels[std::size_t{place.y + y} * light.map.width + place.x + x].x();
  };
  EXPECT_LT(at(0.23f, 0.5f), 0.2f * at(0.77f, 0.5f));
}

TEST(StudioHall, LeavesTheAthleteRoom) {
  for (const Surface& surface : buildHall(4)) {
    if (surface.cover == Cover::kFloor) continue;
    for (const auto& corner : surface.corners) {
      if (corner.z() < 2.2f) {
        EXPECT_GT(corner.head<2>().norm(), 3.0f);
      }
    }
  }
}

TEST(StudioLamps, RippleOnThreePhasesOfTheMains) {
  const auto lamps = hallLamps(1);
  ASSERT_GT(lamps.size(), emulator::studio::kKeyLamps);
  int differ = 0;
  for (const Lamp& lamp : lamps) {
    if (!lamp.ripples) continue;
    EXPECT_NEAR(lamp.ripple(0), lamp.ripple(0.01), 1e-4) << "100 Hz comes back after 10 ms";
    EXPECT_NEAR(lamp.ripple(0) + lamp.ripple(0.005), 2, 1e-4) << "half a period later, mirrored";
    if (std::abs(lamp.ripple(0) - lamps.front().ripple(0)) > 0.01f) ++differ;
  }
  EXPECT_GT(differ, 5);
}

}  // namespace
