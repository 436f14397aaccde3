#pragma once

#include <array>
#include <cstdint>

namespace hal {

enum class PixelFormat : std::uint8_t { kBayerRG8, kBayerGB8, kBayerGR8, kBayerBG8, kMono8 };

inline constexpr std::array kPixelFormats = {PixelFormat::kBayerRG8, PixelFormat::kBayerGB8,
                                             PixelFormat::kBayerGR8, PixelFormat::kBayerBG8,
                                             PixelFormat::kMono8};

/// GenICam's name of the format.
[[nodiscard]] constexpr const char* genicamName(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerRG8:
      return "BayerRG8";
    case PixelFormat::kBayerGB8:
      return "BayerGB8";
    case PixelFormat::kBayerGR8:
      return "BayerGR8";
    case PixelFormat::kBayerBG8:
      return "BayerBG8";
    case PixelFormat::kMono8:
      return "Mono8";
  }
  return "";
}

}  // namespace hal
