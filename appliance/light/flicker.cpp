#include "appliance/light/flicker.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

constexpr std::uint32_t kGrid = 32;  // cells to each side: 32 x 32 cells of 4 pixels
// The middle, in grid cells, that is left out.
constexpr std::uint32_t kMiddleBegin = kGrid / 4;
constexpr std::uint32_t kMiddleEnd = kGrid - kGrid / 4;

// Darker than this there is nothing to be gained: noise would set the picture's brightness.
constexpr double kDarkest = 2;

bool inMiddle(std::uint32_t cell) {
  return cell >= kMiddleBegin && cell < kMiddleEnd;
}

}  // namespace

double backgroundLuminance(std::span<const std::byte> pixels, std::uint32_t width_px,
                           std::uint32_t height_px) RT_SAFE {
  if (width_px < 2 || height_px < 2 || pixels.size() < std::size_t{width_px} * height_px) return 0;
  // A Bayer cell's four colours count alike wherever the grid puts it.
  const auto even = [](std::uint32_t cell, std::uint32_t size) {
    return std::uint64_t{cell} * (size / 2) / kGrid * 2;
  };
  std::uint32_t sum = 0;
  std::uint32_t count = 0;
  for (std::uint32_t row = 0; row < kGrid; ++row) {
    const std::size_t upper = even(row, height_px) * width_px;
    for (std::uint32_t column = 0; column < kGrid; ++column) {
      if (inMiddle(row) && inMiddle(column)) continue;
      const std::size_t first = upper + even(column, width_px);
      for (const std::size_t at : {first, first + 1, first + width_px, first + width_px + 1}) {
        sum += std::to_integer<std::uint32_t>(pixels[at]);
      }
      count += 4;
    }
  }
  return static_cast<double>(sum) / count;
}

std::string flickerText(const FlickerReport& report) {
  return textOf(phrase<Word::kLightEvened>(100 * report.before, 100 * report.after));
}

float FlickerCompensation::gain(std::uint32_t camera, double luminance) RT_SAFE {
  if (camera >= kCameras || luminance < kDarkest) return 1;
  Mean& mean = means_[camera];
  // The first pictures count alike, later ones fade out.
  mean.pictures = std::min<std::uint32_t>(mean.pictures + 1, static_cast<std::uint32_t>(kPictures));
  mean.luminance += (luminance - mean.luminance) / mean.pictures;
  const double gain = std::clamp(mean.luminance / luminance, 1 / kMostGain, kMostGain);

  const double before = luminance / mean.luminance - 1;
  const double after = gain * luminance / mean.luminance - 1;
  before_ += (before * before - before_) / kPictures;
  after_ += (after * after - after_) / kPictures;
  return static_cast<float>(gain);
}

FlickerReport FlickerCompensation::report() const RT_SAFE {
  return {.before = std::sqrt(before_), .after = std::sqrt(after_)};
}

}  // namespace appliance
