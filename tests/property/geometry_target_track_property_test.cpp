#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/geometry/target_track.h"
#include "tests/property/any_value.h"

namespace {

using appliance::Target;
using appliance::TargetOrigin;
using appliance::TargetPoint;
using appliance::TargetReader;
using appliance::TargetTrack;
using property_test::anyIn;

TargetPoint anyPoint() {
  const auto metres = [] { return 0.001 * anyIn<int>(-5000, 5000); };
  return {metres(), metres(), metres()};
}

bool inHull(const TargetPoint& point, const TargetPoint& a, const TargetPoint& b) {
  const auto lies = [](double value, double one, double other) {
    return std::min(one, other) <= value && value <= std::max(one, other);
  };
  return lies(point.x_m, a.x_m, b.x_m) && lies(point.y_m, a.y_m, b.y_m) &&
         lies(point.z_m, a.z_m, b.z_m);
}

double apart(const TargetPoint& a, const TargetPoint& b) {
  return (a.vector() - b.vector()).norm();
}

/// What was measured, and revised since: instant to point.
using Model = std::map<std::int64_t, TargetPoint>;

Model anyMeasurements(TargetTrack& track) {
  Model model;
  std::int64_t at_ns = anyIn<std::int64_t>(1, 1'000'000'000);
  for (int i = anyIn<int>(1, 60); i > 0; --i) {
    const TargetPoint point = anyPoint();
    RC_ASSERT(track.measure(rt::fromNs(at_ns), point, 0.5));
    model[at_ns] = point;
    at_ns += anyIn<std::int64_t>(1, 700'000'000);
  }
  for (int i = anyIn<int>(0, 20); i > 0; --i) {
    auto revised = std::next(model.begin(), anyIn<int>(0, static_cast<int>(model.size())));
    revised->second = anyPoint();
    RC_ASSERT(track.revise(rt::fromNs(revised->first), revised->second, 0.5));
  }
  return model;
}

RC_GTEST_PROP(TargetTrackProperty, AnAnswerLiesInTheHullOfItsNeighboursOrCloseToTheNewest, ()) {
  TargetTrack track;
  const Model model = anyMeasurements(track);
  TargetReader reader(track);
  for (int i = 0; i < 50; ++i) {
    const auto at_ns = anyIn<std::int64_t>(1, model.rbegin()->first + 2'000'000'000);
    const Target target = reader.at(rt::fromNs(at_ns), {});
    const auto after = model.upper_bound(at_ns);
    if (after == model.begin()) {
      RC_ASSERT(target.origin == TargetOrigin::kRig);
      continue;
    }
    const auto before = std::prev(after);
    if (after == model.end()) {
      RC_ASSERT(apart(target.point, before->second) <= 0.5 + 1e-9);
      RC_ASSERT(target.origin ==
                (before->first == at_ns ? TargetOrigin::kMeasured : TargetOrigin::kPredicted));
      continue;
    }
    RC_ASSERT(inHull(target.point, before->second, after->second));
    const bool close = after->first - before->first <= 500'000'000 || before->first == at_ns;
    RC_ASSERT(target.origin == (close ? TargetOrigin::kMeasured : TargetOrigin::kPredicted));
  }
}

RC_GTEST_PROP(TargetTrackProperty, ARevisionGrowsWithWhateverAnAnswerRestsOn, ()) {
  TargetTrack track;
  Model model = anyMeasurements(track);
  TargetReader reader(track);
  const auto revised = std::next(model.begin(), anyIn<int>(0, static_cast<int>(model.size())));
  const rt::Timestamp at = rt::fromNs(revised->first);
  const Target before = reader.at(at, {});
  RC_ASSERT(reader.at(at, {}).revision == before.revision);
  RC_ASSERT(track.revise(at, anyPoint(), 1));
  RC_ASSERT(reader.at(at, {}).revision > before.revision);
}

/// Commands of people, in any order and for any moments, against the plainest model: what was said
/// last about an instant holds.
RC_GTEST_PROP(TargetTrackProperty, WhatAPersonSaidLastAboutAnInstantHolds, ()) {
  TargetTrack track;
  for (std::int64_t ms = 0; ms <= 1000; ms += 100)
    RC_ASSERT(track.measure(rt::fromNs(1 + ms * 1'000'000), {0, 0, 1}, 1));
  std::array<std::optional<double>, 100> said{};  // by instants of 10 ms
  for (int i = anyIn<int>(1, 8); i > 0; --i) {    // no more: none is forgotten
    const auto from = anyIn<std::size_t>(0, said.size());
    const bool set = anyIn<int>(0, 3) > 0;
    const double x_m = anyIn<int>(1, 1000);
    const rt::Timestamp instant = rt::fromNs(1 + static_cast<std::int64_t>(from) * 10'000'000);
    if (set)
      track.setByHand({x_m, 0, 0}, instant);
    else
      track.release(instant);
    std::fill(said.begin() + static_cast<std::ptrdiff_t>(from), said.end(),
              set ? std::optional(x_m) : std::nullopt);
  }
  TargetReader reader(track);
  for (std::size_t i = 0; i < said.size(); ++i) {
    const Target target = reader.at(rt::fromNs(1 + static_cast<std::int64_t>(i) * 10'000'000), {});
    RC_ASSERT((target.origin == TargetOrigin::kByHand) == said[i].has_value());
    if (said[i]) RC_ASSERT(target.point.x_m == *said[i]);
  }
}

}  // namespace
