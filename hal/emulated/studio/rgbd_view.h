#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/emulated/openni/ring.h"
#include "hal/emulated/studio/backdrop.h"
#include "hal/emulated/studio/patch.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/studio_rig.h"

namespace emulator::studio {

/// What differs in one picture of the depth sensor from the empty hall.
struct RgbdPatch {
  /// Depth is kept in these steps, far finer than any sensor's, up to 16 m.
  static constexpr float kStep_m = 0.25e-3f;

  std::vector<PixelRun> runs;
  std::vector<std::uint16_t> depth_steps;  ///< of all runs, one after the other; 0: farther
  std::vector<std::uint8_t> colour_rgb;    ///< the same, sRGB

  void putInto(const DepthRingWriter::Canvas& canvas) const;
  void save(std::vector<std::byte>& to) const;
  /// The next of @p bytes, which it takes off their front; nothing when they hold none.
  [[nodiscard]] static std::optional<RgbdPatch> load(std::span<const std::byte>& bytes,
                                                     std::size_t pixels);
};

/// What the depth sensor sees, without any fault of a sensor: those are the driver's.
///
/// Threads  const, any.
class RgbdView {
 public:
  RgbdView(const StudioCamera& camera, const Backdrop& backdrop);

  [[nodiscard]] static std::size_t savedBytes(SizePx size);
  /// From what save() gave, savedBytes() of them.
  RgbdView(const StudioCamera& camera, std::span<const std::byte> saved);
  void save(std::vector<std::byte>& to) const;

  [[nodiscard]] const std::vector<float>& depth_m() const { return depth_m_; }
  void drawEmpty(const DepthRingWriter::Canvas& canvas) const;
  /// @p depth_m: of people and hall, CV_32F.
  [[nodiscard]] RgbdPatch develop(const std::vector<PeoplePicture>& people, const FloorShade& shade,
                                  const cv::Mat& depth_m) const;

 private:
  void findFloor(const StudioCamera& camera);
  void fillEmpty();

  int width_;
  int height_;
  std::vector<float> rgb_;  // light, as in Backdrop
  std::vector<float> depth_m_;
  std::vector<cv::Point2f> floor_;          // where in FloorShade; negative: nowhere
  std::vector<std::uint8_t> colour_empty_;  // sRGB
};

}  // namespace emulator::studio
