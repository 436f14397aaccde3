#include "appliance/director/arc_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appliance/geometry/rig.h"

namespace appliance {
namespace {

static_assert(kMostViews == kMaxCameras);

/// The same direction, from 0 up to 360 degrees.
double turned(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  return rest < 0 ? rest + 360 : rest;
}

/// The shorter way from one direction to the other, with its sign.
double between(double from_deg, double to_deg) {
  return turned(to_deg - from_deg + 180) - 180;
}

}  // namespace

ArcPath::ArcPath(std::span<const double> azimuths_deg) RT_SAFE {
  count_ = static_cast<std::uint32_t>(std::min(azimuths_deg.size(), kMostViews));
  double walked_deg = 0;
  for (std::uint32_t i = 1; i < count_; ++i)
    walked_deg += between(azimuths_deg[i - 1], azimuths_deg[i]);
  const double sign = walked_deg < 0 ? -1 : 1;
  for (std::uint32_t i = 0; i < count_; ++i)
    stops_[i] = {.angle_deg = turned(sign * azimuths_deg[i]), .camera = i};

  const auto stops = std::span(stops_).first(count_);
  const auto inOrder = [](const Stop& a, const Stop& b) {
    return a.angle_deg != b.angle_deg ? a.angle_deg < b.angle_deg : a.camera < b.camera;
  };
  std::ranges::sort(stops, inOrder);
  std::size_t first = 0;
  double widest_deg = -1;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const double gap_deg = i == 0 ? stops[0].angle_deg + 360 - stops.back().angle_deg
                                  : stops[i].angle_deg - stops[i - 1].angle_deg;
    if (gap_deg <= widest_deg) continue;
    widest_deg = gap_deg;
    first = i;
  }
  const double begin_deg = stops.empty() ? 0 : stops[first].angle_deg;
  for (Stop& stop : stops) stop.angle_deg = turned(stop.angle_deg - begin_deg);
  std::ranges::sort(stops, inOrder);
}

ArcPath ArcPath::even(std::uint32_t cameras) RT_SAFE {
  ArcPath path;
  path.count_ = std::min<std::uint32_t>(cameras, kMostViews);
  for (std::uint32_t i = 0; i < path.count_; ++i)
    path.stops_[i] = {.angle_deg = static_cast<double>(i), .camera = i};
  return path;
}

double ArcPath::angleOf(std::uint32_t camera) const RT_SAFE {
  for (const Stop& stop : std::span(stops_).first(count_))
    if (stop.camera == camera) return stop.angle_deg;
  return 0;
}

double ArcPath::length_deg() const RT_SAFE {
  return count_ == 0 ? 0 : stops_[count_ - 1].angle_deg;
}

double ArcPath::meanStep_deg() const RT_SAFE {
  return count_ < 2 ? 0 : length_deg() / (count_ - 1);
}

ArcPath::Place ArcPath::at(double angle_deg) const RT_SAFE {
  if (count_ == 0) return {};
  const auto stops = std::span(stops_).first(count_);
  const auto right = std::ranges::upper_bound(stops, angle_deg, {}, &Stop::angle_deg);
  if (right == stops.begin()) return {stops.front().camera, stops.front().camera, 0};
  if (right == stops.end()) return {stops.back().camera, stops.back().camera, 0};
  const Stop& left = *(right - 1);
  return {left.camera, right->camera,
          (angle_deg - left.angle_deg) / (right->angle_deg - left.angle_deg)};
}

ArcPath arcOf(const Rig& rig) RT_SAFE {
  std::array<double, kMostViews> azimuths_deg{};
  const std::size_t cameras = std::min(rig.cameras.size(), kMostViews);
  for (std::size_t i = 0; i < cameras; ++i) {
    const Eigen::Vector3d from_target = rig.cameras[i].centre_m() - rig.target_m;
    azimuths_deg[i] = std::atan2(from_target.y(), from_target.x()) * 180 / std::numbers::pi;
  }
  return ArcPath(std::span(azimuths_deg).first(cameras));
}

}  // namespace appliance
