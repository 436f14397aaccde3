#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/director/arc_path.h"
#include "tests/property/any_value.h"

namespace {

using appliance::ArcPath;
using property_test::anyIn;

/// An arc, numbered in either direction, with any spacing, that begins anywhere.
struct AnyArc {
  AnyArc() : cameras(anyIn(1U, 65U)) {
    const double sign = anyIn(0, 2) == 0 ? 1 : -1;
    double angle_deg = anyIn(-7200, 7200) / 10.0;
    for (std::uint32_t i = 0; i < cameras; ++i) {
      azimuths_deg.push_back(angle_deg);
      angle_deg += sign * anyIn(1, 20) / 8.0;  // 160 degrees at most
    }
  }
  std::uint32_t cameras;
  std::vector<double> azimuths_deg;
};

RC_GTEST_PROP(ArcPathProperty, AnglesGrowWithTheCamerasOfAnArcAndKeepTheirDistances, ()) {
  const AnyArc any;
  const ArcPath arc(any.azimuths_deg);
  RC_ASSERT(arc.angleOf(0) == 0);
  for (std::uint32_t i = 1; i < any.cameras; ++i) {
    const double step_deg = arc.angleOf(i) - arc.angleOf(i - 1);
    RC_ASSERT(step_deg > 0);
    RC_ASSERT(std::abs(step_deg - std::abs(any.azimuths_deg[i] - any.azimuths_deg[i - 1])) < 1e-9);
  }
  RC_ASSERT(std::abs(arc.length_deg() - arc.angleOf(any.cameras - 1)) < 1e-9);
}

RC_GTEST_PROP(ArcPathProperty, ARigInAnyOrderHasEveryCameraOnceInRisingOrder, ()) {
  std::vector<double> azimuths_deg;
  const auto cameras = anyIn(1U, 65U);
  for (std::uint32_t i = 0; i < cameras; ++i) azimuths_deg.push_back(anyIn(-720, 720));
  const ArcPath arc(azimuths_deg);
  RC_ASSERT(arc.cameras() == cameras);
  for (std::uint32_t i = 0; i < cameras; ++i) {
    const double angle_deg = arc.angleOf(i);
    RC_ASSERT(angle_deg >= 0);
    RC_ASSERT(angle_deg <= arc.length_deg());
    const auto found = arc.nearest(angle_deg, [](std::uint32_t) { return true; });
    RC_ASSERT(arc.angleOf(*found) == angle_deg);
  }
}

RC_GTEST_PROP(ArcPathProperty, AnAngleLiesWhereItsMixSays, ()) {
  const AnyArc any;
  const ArcPath arc(any.azimuths_deg);
  const double angle_deg = arc.length_deg() * anyIn(-100, 1100) / 1000.0;
  const ArcPath::Place place = arc.at(angle_deg);
  RC_ASSERT(place.mix >= 0);
  RC_ASSERT(place.mix < 1);
  const double mixed_deg =
      arc.angleOf(place.left) * (1 - place.mix) + arc.angleOf(place.right) * place.mix;
  RC_ASSERT(std::abs(mixed_deg - std::clamp(angle_deg, 0.0, arc.length_deg())) < 1e-9);
}

}  // namespace
