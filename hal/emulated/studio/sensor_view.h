#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/emulated/studio/backdrop.h"
#include "hal/emulated/studio/patch.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/studio_rig.h"

namespace emulator::studio {

/// Moments of the scene follow one another at this rate; with it the ripple of the mains meets
/// them in turn at its crest and its trough.
inline constexpr double kMoments_hz = 40;
/// The empty hall exists in so many variants of noise and ripple; moment m lies over variant
/// m % kVariants.
inline constexpr std::uint32_t kVariants = 4;

/// One camera's sensor: turns light into BayerRG8, linear, with vignetting, colour response, noise
/// and the ripple of the lamps.
class SensorView {
 public:
  SensorView(const StudioCamera& camera, std::uint32_t number, const Backdrop& backdrop);
  /// From what save() gave.
  static std::size_t savedBytes(SizePx size);
  SensorView(const StudioCamera& camera, std::uint32_t number, std::span<const std::byte> saved);
  void save(std::vector<std::byte>& to) const;

  /// The empty hall with its noise: the whole sensor.
  [[nodiscard]] std::vector<std::uint8_t> background(std::uint32_t variant) const;
  /// People over it, and the shade they throw on the floor.
  [[nodiscard]] Patch develop(std::uint64_t moment, const std::vector<PeoplePicture>& people,
                              const FloorShade& shade) const;

 private:
  struct Pixel {               // of the empty hall
    std::uint16_t signal = 0;  // DN times kSignalScale
    std::int8_t ripple = 0;    // times kRippleScale
    std::int8_t unused = 0;
    std::uint16_t floor_x = kNoFloor;  // in FloorShade's steps times kFloorScale
    std::uint16_t floor_y = kNoFloor;
  };
  static constexpr std::uint16_t kNoFloor = 0xffff;
  [[nodiscard]] float signalOf(const Pixel& pixel, std::uint32_t variant) const;
  [[nodiscard]] std::uint8_t digitise(float signal_dn, float normal) const;
  [[nodiscard]] cv::Rect shadedArea(const FloorShade& shade) const;

  StudioCamera camera_;
  std::uint32_t number_;
  int width_;
  int height_;
  std::vector<Pixel> pixels_;
};

}  // namespace emulator::studio
