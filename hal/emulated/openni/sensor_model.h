#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/emulated/openni/ring.h"

namespace emulator {

/// What a structured-light sensor of the PrimeSense family is like. It measures disparity between
/// its projector and its infra-red camera, so depth errors grow with the square of the distance.
struct SensorTraits {
  double baseline_m = 0.075;           ///< projector right of the infra-red camera
  double colour_baseline_m = 0.025;    ///< colour camera right of it; seen without registration
  double disparity_step_px = 1.0 / 8;  ///< the quantisation: 26 mm at 3 m
  double disparity_noise_px = 0.07;    ///< rms
  double nearest_m = 0.5;
  double farthest_m = 8.0;
  double lost_share = 0.004;        ///< of all pixels, anywhere
  double dark_lost_share = 0.25;    ///< of black pixels at the farthest distance
  double grazing_m_per_px = 0.035;  ///< surfaces seen steeper than this return too little light
  double colour_noise = 2.0;        ///< rms, of 255
  std::uint64_t seed = 1;
};

/// Turns a perfect picture into what such a sensor delivers. A pure function of the picture, its
/// number and the seed: the same input gives the same output on every machine.
///
/// Threads  One caller.
/// Memory   Allocates when made, not afterwards.
class SensorModel {
 public:
  SensorModel(const SensorTraits& traits, const RgbdFormat& format);

  /// Millimetres, 0 where nothing is measured. @p colour_rgb may be empty: then nothing is dark.
  void senseDepth(std::span<const float> depth_m, std::span<const std::uint8_t> colour_rgb,
                  std::uint64_t number, std::span<std::uint16_t> depth_mm);

  void senseColour(std::span<const std::uint8_t> perfect_rgb, std::uint64_t number,
                   std::span<std::uint8_t> colour_rgb) const;

  /// Depth as the infra-red camera sees it, from depth in the colour camera's pixels: what the
  /// sensor delivers if its client does not ask for registered depth.
  void unregister(std::span<const std::uint16_t> registered_mm,
                  std::span<std::uint16_t> depth_mm) const;

 private:
  static constexpr std::size_t kNoiseSize = 1U << 16U;

  void senseRow(const float* depth_m, const std::uint8_t* rgb, std::uint64_t random,
                std::uint16_t* depth_mm);

  SensorTraits traits_;
  RgbdFormat format_;
  std::array<float, kNoiseSize> noise_;           // normal, mean 0, rms 1
  std::array<std::uint16_t, kNoiseSize> chance_;  // even
  std::vector<std::uint16_t> mm_of_step_;         // by whole disparity steps
  std::vector<std::uint8_t> shadow_;              // one row
};

}  // namespace emulator
