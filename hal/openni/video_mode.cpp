#include "hal/openni/video_mode.h"

#include <cmath>
#include <utility>

namespace hal::openni {
namespace {

/// How far a mode is from what is wanted: the size first, then its shape, then the rate.
auto distance(const VideoMode& mode, const VideoMode& wanted) {
  const auto ratio = [](double a, double b) { return std::abs(std::log(a / b)); };
  const double size =
      ratio(1.0 * mode.width_px * mode.height_px, 1.0 * wanted.width_px * wanted.height_px);
  const double shape =
      ratio(1.0 * mode.width_px * wanted.height_px, 1.0 * mode.height_px * wanted.width_px);
  return std::pair(size + shape, ratio(mode.rate_hz, wanted.rate_hz));
}

}  // namespace

std::optional<std::size_t> nearestMode(std::span<const VideoMode> modes, const VideoMode& wanted) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const VideoMode& mode = modes[i];
    if (mode.width_px == 0 || mode.height_px == 0 || mode.rate_hz == 0) continue;
    if (!best || distance(mode, wanted) < distance(modes[*best], wanted)) best = i;
  }
  return best;
}

}  // namespace hal::openni
