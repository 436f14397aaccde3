#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "appliance/geometry/coverage.h"
#include "appliance/geometry/homography.h"
#include "appliance/geometry/rig_shelf.h"
#include "hal/warp_plan.h"
#include "rt/annotations.h"

namespace appliance {

/// All views of one target, by one rig, on one screen. What follows from them is computed when one
/// of them changes, and kept.
///
/// Threads  One: the render thread.
/// RT       RT safe. A target that moves costs 0.1 to 0.5 ms for 20 cameras; another rig or screen
///          1 to 2 ms more for the zoom that covers it.
class ViewSet {
 public:
  /// @p zoom: none: the smallest that leaves no border, coverZoom().
  explicit ViewSet(std::optional<double> zoom) : fixed_zoom_(zoom) {}

  void update(const RigPin& rig, std::uint32_t width_px, std::uint32_t height_px,
              const Eigen::Vector3d& target_m) RT_SAFE;

  /// What shows @p source, a frame of that camera; nothing where planWarp() gives nothing. All
  /// views of good sight have the same edge.
  [[nodiscard]] std::optional<hal::WarpPlan> plan(const RigPin& rig, std::uint32_t camera,
                                                  const hal::SourceImage& source) const RT_SAFE;

  /// Good before the first update().
  [[nodiscard]] Sight sight(std::uint32_t camera) const RT_SAFE {
    return revision_ == 0 ? Sight::kGood : edge_.sight[camera];
  }
  [[nodiscard]] double zoom() const RT_SAFE { return parameters_.zoom; }
  /// Of the present rig and screen; nothing with a fixed zoom.
  [[nodiscard]] const std::optional<CoverZoom>& cover() const RT_SAFE { return cover_; }

 private:
  std::optional<double> fixed_zoom_;
  std::uint64_t revision_ = 0;  // of the rig; 0: no update yet
  ViewParameters parameters_;
  Eigen::Vector3d target_m_ = Eigen::Vector3d::Zero();
  std::optional<CoverZoom> cover_;
  std::array<View, kMaxCameras> views_{};
  SharedEdge edge_;
};

}  // namespace appliance
