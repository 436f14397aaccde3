#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <xf86drmMode.h>

namespace ui::kms {

/// The true refresh rate: pixel clock / (htotal * vtotal), twice that where a frame is two fields,
/// half where every line is sent twice. The rate in a mode's name is rounded.
[[nodiscard]] double refreshHz(const drmModeModeInfo& mode);

/// The mode that a site chose, "1920x1080@59.94" or "1920x1080"; no rate: any.
struct ModeSpec {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  double refresh_hz = 0;
  friend bool operator==(const ModeSpec&, const ModeSpec&) = default;
};

/// None if the text is empty: the box chooses. Errors: one line.
[[nodiscard]] std::expected<std::optional<ModeSpec>, std::string> parseModeSpec(
    std::string_view text);

/// Whether @p mode is what @p spec means: that size, and within 1 % of the rate.
[[nodiscard]] bool fulfils(const drmModeModeInfo& mode, const ModeSpec& spec);

/// Whether every trigger has its own flip, evenly: the refresh rate is a whole multiple of
/// @p trigger_hz within 0.5 %, which is what the trigger can give way.
[[nodiscard]] bool isMultiple(double refresh_hz, double trigger_hz);

/// The modes of a screen, the one to use first. By rank: fulfils the spec (the nearest rate
/// first); whole pictures rather than two fields; a whole multiple of the trigger rate; what the
/// screen prefers; larger; faster. Pure.
[[nodiscard]] std::vector<drmModeModeInfo> rankModes(std::span<const drmModeModeInfo> modes,
                                                     double trigger_hz,
                                                     const std::optional<ModeSpec>& spec);

/// The same timing, whatever the name and the type flags.
[[nodiscard]] bool sameTiming(const drmModeModeInfo& a, const drmModeModeInfo& b);

/// "1920x1080 at 59.94 Hz".
[[nodiscard]] std::string describe(const drmModeModeInfo& mode);

}  // namespace ui::kms
