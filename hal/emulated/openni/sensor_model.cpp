#include "hal/emulated/openni/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace emulator {
namespace {

/// SplitMix64: one number in, an unrelated one out.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

std::uint16_t chanceOf(double share) {
  return static_cast<std::uint16_t>(std::clamp(share, 0.0, 1.0) * 65535);
}

}  // namespace

SensorModel::SensorModel(const SensorTraits& traits, const RgbdFormat& format)
    : traits_(traits), format_(format), noise_{}, chance_{}, shadow_(format.width_px) {
  std::uint64_t state = mix(traits.seed);
  for (std::size_t i = 0; i < kNoiseSize; ++i) {
    // The sum of twelve even numbers is normal enough, and the same with every library.
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>((state = mix(state)) >> 11U) * 0x1p-53;
    noise_[i] = static_cast<float>(sum);
    chance_[i] = static_cast<std::uint16_t>((state = mix(state)) >> 48U);
  }
  const double nearest = format.focal_px * traits.baseline_m / traits.nearest_m;
  const auto steps = static_cast<std::size_t>(nearest / traits.disparity_step_px) + 1;
  mm_of_step_.resize(steps + 1);
  for (std::size_t i = 1; i <= steps; ++i) {
    const double depth_m =
        format.focal_px * traits.baseline_m / (static_cast<double>(i) * traits.disparity_step_px);
    const bool seen = depth_m >= traits.nearest_m && depth_m <= traits.farthest_m;
    mm_of_step_[i] = seen ? static_cast<std::uint16_t>(std::lround(depth_m * 1000)) : 0;
  }
}

void SensorModel::senseRow(const float* depth_m, const std::uint8_t* rgb, std::uint64_t random,
                           std::uint16_t* depth_mm) {
  const std::uint32_t width = format_.width_px;
  const auto f_b = static_cast<float>(format_.focal_px * traits_.baseline_m);
  // The projector, on the right, lights pixel x by its ray x - disparity: where something nearer
  // to the right of it has taken that ray, the pixel lies in its shadow.
  float taken = 1e9F;
  for (std::uint32_t x = width; x-- > 0;) {
    const float z = depth_m[x];
    const float ray = z > 0 ? static_cast<float>(x) - f_b / z : 1e9F;
    shadow_[x] = z > 0 && ray > taken + 0.5F ? 1 : 0;
    taken = std::min(taken, ray);
  }
  const auto step = static_cast<float>(traits_.disparity_step_px);
  const auto noise_px = static_cast<float>(traits_.disparity_noise_px);
  const auto grazing = static_cast<float>(traits_.grazing_m_per_px);
  const auto farthest = static_cast<float>(traits_.farthest_m);
  const std::uint16_t lost = chanceOf(traits_.lost_share);
  const auto dark_scale = static_cast<float>(traits_.dark_lost_share * 65535);
  const std::size_t steps = mm_of_step_.size();
  for (std::uint32_t x = 0; x < width; ++x) {
    const std::size_t at = (random + x) % kNoiseSize;
    const std::uint16_t chance = chance_[at];
    // The silhouette of what is near frays: now and then a pixel sees its neighbour instead.
    const std::uint32_t side = (chance & 6U) == 0 ? ((chance & 1U) != 0 ? 1 : width) : 0;
    std::uint32_t from = x;
    if (side == 1 && x + 1 < width) from = x + 1;
    if (side == width && x > 0) from = x - 1;
    const float z = depth_m[from];
    depth_mm[x] = 0;
    if (!(z > 0) || z > farthest || shadow_[from] != 0 || chance < lost) continue;
    const float behind = depth_m[from + 1 < width ? from + 1 : from];
    const float before = depth_m[from > 0 ? from - 1 : from];
    const float slope = std::abs(behind - before) * 0.5F;
    // Edges are jumps, not slopes: they fray and cast shadows instead.
    if (slope > grazing * z && slope < 0.25F) continue;
    if (rgb != nullptr) {
      const int brightness = std::max({rgb[3 * from], rgb[3 * from + 1], rgb[3 * from + 2]});
      const float dark = std::max(0.0F, 1.0F - static_cast<float>(brightness) / 40.0F);
      const float far = z / farthest;
      if (dark > 0 && static_cast<float>(chance ^ 0x5a5aU) < dark_scale * dark * far * far)
        continue;
    }
    const float disparity = f_b / z + noise_px * noise_[at];
    const auto index = static_cast<std::int64_t>(std::lround(disparity / step));
    if (index < 1 || index >= static_cast<std::int64_t>(steps)) continue;
    depth_mm[x] = mm_of_step_[static_cast<std::size_t>(index)];
  }
}

void SensorModel::senseDepth(std::span<const float> depth_m,
                             std::span<const std::uint8_t> colour_rgb, std::uint64_t number,
                             std::span<std::uint16_t> depth_mm) {
  for (std::uint32_t y = 0; y < format_.height_px; ++y) {
    const std::size_t row = std::size_t{y} * format_.width_px;
    const std::uint64_t random = mix(mix(number ^ (traits_.seed << 32U)) + y);
    senseRow(depth_m.data() + row, colour_rgb.empty() ? nullptr : colour_rgb.data() + 3 * row,
             random, depth_mm.data() + row);
  }
}

void SensorModel::senseColour(std::span<const std::uint8_t> perfect_rgb, std::uint64_t number,
                              std::span<std::uint8_t> colour_rgb) const {
  const auto rms = static_cast<float>(traits_.colour_noise);
  const std::size_t row_bytes = std::size_t{format_.width_px} * 3;
  for (std::uint32_t y = 0; y < format_.height_px; ++y) {
    const std::uint64_t random = mix(mix(number ^ (traits_.seed << 31U)) + (y | 0x10000U));
    const std::size_t row = y * row_bytes;
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const float value =
          static_cast<float>(perfect_rgb[row + i]) + rms * noise_[(random + i) % kNoiseSize] + 0.5F;
      colour_rgb[row + i] = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
    }
  }
}

void SensorModel::unregister(std::span<const std::uint16_t> registered_mm,
                             std::span<std::uint16_t> depth_mm) const {
  const auto shift_mm = static_cast<float>(format_.focal_px * traits_.colour_baseline_m * 1000);
  const auto width = static_cast<std::int64_t>(format_.width_px);
  std::ranges::fill(depth_mm, std::uint16_t{0});
  for (std::size_t row = 0; row < registered_mm.size(); row += format_.width_px) {
    for (std::int64_t x = 0; x < width; ++x) {
      const std::uint16_t mm = registered_mm[row + static_cast<std::size_t>(x)];
      if (mm == 0) continue;
      // Seen from the left of the colour camera a point lies further right.
      const std::int64_t to = x + std::lround(shift_mm / static_cast<float>(mm));
      if (to >= width) continue;
      std::uint16_t& there = depth_mm[row + static_cast<std::size_t>(to)];
      if (there == 0 || mm < there) there = mm;
    }
  }
}

}  // namespace emulator
