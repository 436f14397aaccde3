#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "appliance/geometry/homography.h"
#include "appliance/geometry/rig.h"
#include "hal/edge_mask.h"
#include "rt/annotations.h"

/// How much of the display a camera's picture covers. All pure.
namespace appliance {

/// How well a view shows the target.
enum class Sight : std::uint8_t {
  kNone,  ///< the target lies outside the camera's picture, or behind the camera
  kPoor,  ///< so near to the picture's edge that this view would narrow all others too much
  kGood,
};

/// A view of narrowing above this is kPoor: it ends less than 40 % of the way to the screen's edge.
inline constexpr double kMostNarrowing = 2.5;

/// Narrows @p mask to what the view has of the display, if that takes no more than @p most at any
/// place; else the mask stays.
/// RT safe: some 64 points where the view lacks nothing, each a microsecond's twentieth.
Sight tryNarrow(hal::EdgeMask& mask, const RigCamera& camera, const View& view,
                const ViewParameters& parameters,
                double most = std::numeric_limits<double>::infinity()) RT_SAFE;

/// The edge that all views of one target share, so that it stays in its place when the view
/// changes.
struct SharedEdge {
  hal::EdgeMask mask;  ///< of all views of good sight
  std::array<Sight, kMaxCameras> sight{};
};

/// @p views: of all cameras of @p rig, by @p parameters.
/// RT safe; about 0.1 ms for 20 cameras that cover the screen, up to 0.5 ms otherwise.
[[nodiscard]] SharedEdge sharedEdge(const Rig& rig, std::span<const View> views,
                                    const ViewParameters& parameters) RT_SAFE;

/// More zoom than this shows too little of the athlete.
inline constexpr double kMostCoverZoom = 4;

struct CoverZoom {
  double zoom = 1;  ///< at most kMostCoverZoom
  /// What each camera needs for the target volume; 0 where it does not see all of it, which then
  /// does not count.
  std::array<double, kMaxCameras> needed{};
  std::uint32_t worst = 0;  ///< the camera that needs most
};

/// The smallest zoom at which every view that sees the target covers a display of that size, for
/// all targets in Rig::target_volume.
/// RT safe; 1 to 2 ms for 20 cameras.
[[nodiscard]] CoverZoom coverZoom(const Rig& rig, std::uint32_t width_px,
                                  std::uint32_t height_px) RT_SAFE;

/// The part of the display that the view fills, 0 to 1.
[[nodiscard]] double filledPart(const RigCamera& camera, const View& view,
                                const ViewParameters& parameters);

/// The part of the camera's picture that is on the display, 0 to 1.
[[nodiscard]] double usedPart(const RigCamera& camera, const View& view,
                              const ViewParameters& parameters);

}  // namespace appliance
