#include "appliance/depth/lamp_finder.h"

#include <algorithm>
#include <cstddef>

namespace appliance {

void LampFinder::add(const hal::DepthFrame& frame) {
  Picture picture{.at = frame.colour_exposure, .cells = {}};
  const std::uint32_t wide = frame.width_px / kColumns;
  const std::uint32_t high = frame.height_px / kRows;
  for (std::uint32_t y = 0; y < kRows * high; ++y) {
    const std::uint8_t* row = &frame.colour_rgb[std::size_t{3} * y * frame.width_px];
    for (std::uint32_t x = 0; x < kColumns * wide; ++x) {
      picture.cells[std::size_t{y / high} * kColumns + x / wide] +=
          static_cast<float>(row[3 * x] + row[3 * x + 1] + row[3 * x + 2]);
    }
  }
  for (float& cell : picture.cells) cell /= static_cast<float>(3 * wide * high);
  pictures_.push_back(picture);
}

std::vector<LampSample> LampFinder::samples() const {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t cell = 0; cell < Cells{}.size(); ++cell) {
    double sum = 0;
    double squares = 0;
    for (const Picture& picture : pictures_) {
      const double value = picture.cells[cell];
      sum += value;
      squares += value * value;
    }
    const auto n = static_cast<double>(std::max<std::size_t>(pictures_.size(), 1));
    const double variance = squares / n - (sum / n) * (sum / n);
    if (variance > most) {
      most = variance;
      best = cell;
    }
  }
  std::vector<LampSample> samples;
  for (const Picture& picture : pictures_) samples.push_back({picture.at, picture.cells[best]});
  return samples;
}

}  // namespace appliance
