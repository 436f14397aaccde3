#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "rt/annotations.h"

namespace appliance {

/// The mean raw value of a frame's background, 0 to 255: of whole Bayer cells on a coarse grid,
/// without the middle, where people move. Some thousand pixels, whatever the frame's size.
///
/// RT       Bounded, no allocation. @p pixels: one byte each, rows without padding.
[[nodiscard]] double backgroundLuminance(std::span<const std::byte> pixels, std::uint32_t width_px,
                                         std::uint32_t height_px) RT_SAFE;

/// How much the light of the pictures shown comes and goes: standard deviation of their background
/// over their mean, of the last pictures.
struct FlickerReport {
  double before = 0;  ///< as the cameras saw it
  double after = 0;   ///< as it was shown
};

/// "background brightness varies by 21.3 %, by 0.2 % after compensation"
[[nodiscard]] std::string flickerText(const FlickerReport& report);

/// Gives every picture the brightness that its camera's pictures have on average, so that lamps
/// which beat with the triggers do not show. Slow changes pass: a cloud is no flicker.
///
/// Threads  One.
/// RT       Bounded, fixed storage.
class FlickerCompensation {
 public:
  /// The gain in linear light for a picture of @p camera whose background is @p luminance.
  [[nodiscard]] float gain(std::uint32_t camera, double luminance) RT_SAFE;

  [[nodiscard]] FlickerReport report() const RT_SAFE;

  static constexpr double kMostGain = 2;   ///< and 1 / kMostGain the least
  static constexpr double kPictures = 64;  ///< that the mean remembers
  static constexpr std::size_t kCameras = 64;

 private:
  struct Mean {
    double luminance = 0;
    std::uint32_t pictures = 0;
  };
  std::array<Mean, kCameras> means_{};
  double before_ = 0;  // mean square of the relative deviation
  double after_ = 0;
};

}  // namespace appliance
