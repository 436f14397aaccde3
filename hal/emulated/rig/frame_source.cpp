#include "hal/emulated/rig/frame_source.h"

#include <algorithm>
#include <cstring>

namespace emulator {

bool FrameSource::passesThrough() const {
  return region_.size == region_.sensor && region_.pixel_format == gvsp::kPixelBayerRG8;
}

void FrameSource::prepare(const Region& region) {
  region_ = region;
  const bool copies = !passesThrough();
  sensor_.resize(copies ? std::size_t{region.sensor.width} * region.sensor.height : 0);
  for (auto& slot : slots_) {
    slot.resize(copies ? std::size_t{region.size.width} * region.size.height : 0);
  }
}

gvsp::Picture FrameSource::expose(std::uint64_t trigger, std::uint32_t slot) {
  const gvsp::Picture whole = scene_.expose(camera_, trigger, slot);
  if (passesThrough()) return whole;

  whole.copyTo(sensor_, 0);
  std::uint8_t* out = slots_[slot].data();
  const std::size_t stride = region_.sensor.width;
  for (std::uint32_t y = 0; y < region_.size.height; ++y) {
    const std::size_t row = y + region_.offset_y_px;
    const std::uint8_t* from = &sensor_[row * stride + region_.offset_x_px];
    if (region_.pixel_format == gvsp::kPixelBayerRG8) {
      std::memcpy(out, from, region_.size.width);
    } else {
      const std::ptrdiff_t other_row = row + 1 < region_.sensor.height
                                           ? static_cast<std::ptrdiff_t>(stride)
                                           : -static_cast<std::ptrdiff_t>(stride);
      for (std::uint32_t x = 0; x < region_.size.width; ++x) {
        const std::ptrdiff_t other = x + region_.offset_x_px + 1 < stride ? 1 : -1;
        const std::uint8_t* at = from + x;
        const int sum = at[0] + at[other] + at[other_row] + at[other_row + other];
        out[x] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
    out += region_.size.width;
  }
  return {.pieces = {slots_[slot]}, .overlay = {}};
}

}  // namespace emulator
