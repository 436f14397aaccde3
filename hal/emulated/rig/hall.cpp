#include "hal/emulated/rig/hall.h"

namespace emulator {

std::vector<std::uint8_t> drawHall(const CameraModel& camera) {
  std::vector<std::uint8_t> out(std::size_t{camera.image_size.width} * camera.image_size.height);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<std::uint8_t>(30 + (i / camera.image_size.width) * 60 /
                                                camera.image_size.height);
  }
  return out;
}

}  // namespace emulator
