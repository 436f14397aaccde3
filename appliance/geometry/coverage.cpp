#include "appliance/geometry/coverage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "appliance/geometry/lens.h"

namespace appliance {
namespace {

using hal::EdgeMask;

/// Halvings of the way to a place: a 4K screen's half width in hundredths of a pixel.
constexpr int kHalvings = 18;
/// Coverage is looked for from the narrowest up to this zoom.
constexpr float kWidestPicture = 1.0F / 16;
constexpr float kNarrowestPicture = 1000;

/// Where the camera's picture has what the display shows at (u, v).
std::optional<Point2> sourcePoint(const RigCamera& camera, const View& view,
                                  const ViewParameters& parameters, double u, double v) {
  const double x = (u * parameters.width_px + parameters.width_px - 1.0) / 2;
  const double y = (v * parameters.height_px + parameters.height_px - 1.0) / 2;
  const Homography& h = view.H_camera_display;
  const double w = h[6] * x + h[7] * y + h[8];
  if (!(w > 0)) return std::nullopt;
  const hal::Lens& lens = camera.lens;
  const Point2 ray = {((h[0] * x + h[1] * y + h[2]) / w - lens.cx_px) / lens.fx_px,
                      ((h[3] * x + h[4] * y + h[5]) / w - lens.cy_px) / lens.fy_px};
  if (!(ray[0] * ray[0] + ray[1] * ray[1] <= lens.max_radius * lens.max_radius))
    return std::nullopt;
  return distortedPixel(lens, ray);
}

bool isShown(const RigCamera& camera, const View& view, const ViewParameters& parameters, double u,
             double v) {
  const auto at = sourcePoint(camera, view, parameters, u, v);
  return at && (*at)[0] >= 0 && (*at)[1] >= 0 && (*at)[0] <= camera.width_px - 1.0 &&
         (*at)[1] <= camera.height_px - 1.0;
}

/// The narrowing of one place: @p least, or more where the view needs it. The picture is
/// star-shaped about the target: what lies on the way to a point that is shown is shown.
float narrowingAt(const RigCamera& camera, const View& view, const ViewParameters& parameters,
                  std::size_t place, float least) {
  const auto [u, v] = EdgeMask::pointOf(place);
  const auto shown = [&](double reach) {
    return isShown(camera, view, parameters, reach * u, reach * v);
  };
  double beyond = 1 / static_cast<double>(least);
  if (shown(beyond)) return least;
  double within = 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (within + beyond) / 2;
    (shown(middle) ? within : beyond) = middle;
  }
  return within * kNarrowestPicture > 1 ? static_cast<float>(1 / within) : kNarrowestPicture;
}

/// Targets between which all others of the volume lie.
constexpr std::size_t kCorners = 16;
using Corners = std::array<Eigen::Vector3d, 2 * kCorners>;

/// The corners of the rig's target volume; those of a cylinder are a polygon's around it.
std::span<const Eigen::Vector3d> cornersOf(const Rig& rig, Corners& corners) {
  const TargetVolume& volume = rig.target_volume;
  const Eigen::Vector3d centre_m = volume.centre_m.value_or(rig.target_m);
  const bool box = volume.shape == TargetVolume::Shape::kBox;
  const std::size_t around = box ? 4 : kCorners;
  // The corners of a square around the unit circle's quarter are the box's own.
  const double out = box ? std::numbers::sqrt2 : 1 / std::cos(std::numbers::pi / kCorners);
  for (std::size_t i = 0; i < around; ++i) {
    const double angle =
        std::numbers::pi * (2.0 * static_cast<double>(i) + 1) / static_cast<double>(around);
    const Eigen::Vector3d& half = volume.half_size_m;
    const Eigen::Vector3d side{out * std::cos(angle) * half.x(), out * std::sin(angle) * half.y(),
                               half.z()};
    corners[2 * i] = centre_m + side;
    corners[2 * i + 1] = centre_m + Eigen::Vector3d{side.x(), side.y(), -side.z()};
  }
  return {corners.data(), 2 * around};
}

/// The zoom at which @p camera covers the display for all of @p targets_m; 0: it does not see one.
double neededZoom(const RigCamera& camera, const Rig& rig, const ViewParameters& at_zoom_1,
                  std::span<const Eigen::Vector3d> targets_m) {
  float needed = kWidestPicture;
  for (const Eigen::Vector3d& target_m : targets_m) {
    const View view = viewOf(camera, rig, target_m, at_zoom_1);
    if (!view.valid || !isShown(camera, view, at_zoom_1, 0, 0)) return 0;
    for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place)
      needed = narrowingAt(camera, view, at_zoom_1, place, needed);
  }
  return needed / EdgeMask::kNone;
}

}  // namespace

Sight tryNarrow(EdgeMask& mask, const RigCamera& camera, const View& view,
                const ViewParameters& parameters, double most) RT_SAFE {
  if (!view.valid || !isShown(camera, view, parameters, 0, 0)) return Sight::kNone;
  EdgeMask narrowed = mask;
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place) {
    float& narrowing = narrowed.narrowing[place];
    narrowing = narrowingAt(camera, view, parameters, place, narrowing);
    if (narrowing > most) return Sight::kPoor;
  }
  mask = narrowed;
  return Sight::kGood;
}

SharedEdge sharedEdge(const Rig& rig, std::span<const View> views,
                      const ViewParameters& parameters) RT_SAFE {
  SharedEdge edge;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    edge.sight[i] = tryNarrow(edge.mask, rig.cameras[i], views[i], parameters, kMostNarrowing);
  }
  return edge;
}

CoverZoom coverZoom(const Rig& rig, std::uint32_t width_px, std::uint32_t height_px) RT_SAFE {
  const ViewParameters at_zoom_1{.width_px = width_px, .height_px = height_px, .zoom = 1};
  Corners corners;
  const auto targets_m = cornersOf(rig, corners);
  CoverZoom cover;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    cover.needed[i] = neededZoom(rig.cameras[i], rig, at_zoom_1, targets_m);
    if (cover.needed[i] > cover.needed[cover.worst]) cover.worst = static_cast<std::uint32_t>(i);
  }
  const double needed = cover.needed[cover.worst];
  if (needed > 0) cover.zoom = std::min(needed, kMostCoverZoom);
  return cover;
}

double filledPart(const RigCamera& camera, const View& view, const ViewParameters& parameters) {
  if (!view.valid) return 0;
  constexpr int kColumns = 96;
  constexpr int kRows = 54;
  int shown = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double u = (2.0 * column + 1) / kColumns - 1;
      const double v = (2.0 * row + 1) / kRows - 1;
      if (isShown(camera, view, parameters, u, v)) ++shown;
    }
  }
  return static_cast<double>(shown) / (kColumns * kRows);
}

double usedPart(const RigCamera& camera, const View& view, const ViewParameters& parameters) {
  EdgeMask mask{.narrowing = EdgeMask::everywhere(1)};
  if (tryNarrow(mask, camera, view, parameters) == Sight::kNone) return 0;
  std::array<Point2, EdgeMask::kPlaces> outline;
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place) {
    const auto [u, v] = EdgeMask::pointOf(place);
    const double reach = 1 / static_cast<double>(mask.narrowing[place]);
    outline[place] = sourcePoint(camera, view, parameters, reach * u, reach * v).value_or(Point2{});
  }
  double twice_area_px = 0;
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place) {
    const Point2& a = outline[place];
    const Point2& b = outline[(place + 1) % EdgeMask::kPlaces];
    twice_area_px += a[0] * b[1] - a[1] * b[0];
  }
  return twice_area_px / 2 / (double{1} * camera.width_px * camera.height_px);
}

}  // namespace appliance
