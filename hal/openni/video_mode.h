#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace hal::openni {

/// One way in which a sensor can stream.
struct VideoMode {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint32_t rate_hz = 0;
  bool operator==(const VideoMode&) const = default;
};

/// The index of the mode that is as wanted, else of the one nearest in size (by the logarithm of
/// its pixels), at the rate nearest to the wanted one. None only where there is no mode. Pure.
[[nodiscard]] std::optional<std::size_t> nearestMode(std::span<const VideoMode> modes,
                                                     const VideoMode& wanted);

}  // namespace hal::openni
