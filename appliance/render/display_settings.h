#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace appliance {

class Section;

/// The screen, and how pictures are drawn for it.
struct DisplaySettings {
  std::string backend = "offscreen";
  std::string device;  ///< empty: the first card with a screen
  std::string mode;    ///< "1920x1080@59.94"; empty: the best for the trigger rate
  std::uint32_t queue_depth = 1;
  std::uint32_t width_px = 1280;
  std::uint32_t height_px = 720;
  double refresh_hz = 80;
  std::uint32_t rotation_deg = 0;  ///< how far the screen is turned, clockwise
  std::optional<double> zoom;      ///< none: "cover", the smallest that leaves no border
  std::uint32_t render_threads = 2;
  std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  bool flicker_compensation = false;
  bool operator==(const DisplaySettings&) const = default;
};

/// Reads `[display]`.
void read(Section section, DisplaySettings& display);

}  // namespace appliance
