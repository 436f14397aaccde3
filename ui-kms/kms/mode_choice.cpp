#include "ui-kms/kms/mode_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "rt/printable.h"

namespace ui::kms {
namespace {

constexpr double kTriggerGivesWay = 0.005;
constexpr double kRateTolerance = 0.01;

/// What rankModes() compares, best is least.
auto rank(const drmModeModeInfo& mode, double trigger_hz, const std::optional<ModeSpec>& spec) {
  const double hz = refreshHz(mode);
  const bool chosen = spec && fulfils(mode, *spec);
  const double off = chosen && spec->refresh_hz > 0 ? std::abs(hz - spec->refresh_hz) : 0;
  return std::tuple(!chosen, off, (mode.flags & DRM_MODE_FLAG_INTERLACE) != 0,
                    !isMultiple(hz, trigger_hz), (mode.type & DRM_MODE_TYPE_PREFERRED) == 0,
                    -(std::int64_t{mode.hdisplay} * mode.vdisplay), -hz);
}

}  // namespace

double refreshHz(const drmModeModeInfo& mode) {
  const double pixels = double{1} * mode.htotal * mode.vtotal;
  if (pixels <= 0) return 0;
  double hz = mode.clock * 1000.0 / pixels;
  if ((mode.flags & DRM_MODE_FLAG_INTERLACE) != 0) hz *= 2;
  if ((mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0) hz /= 2;
  if (mode.vscan > 1) hz /= mode.vscan;
  return hz;
}

std::expected<std::optional<ModeSpec>, std::string> parseModeSpec(std::string_view text) {
  if (text.empty()) return std::nullopt;
  const std::string copy(text);
  ModeSpec spec;
  int end = 0;
  const auto whole = [&] { return end > 0 && static_cast<std::size_t>(end) == copy.size(); };
  // sscanf would take signs, spaces and nan.
  const bool plain = copy.find_first_not_of("0123456789.x@") == std::string::npos;
  bool good =
      plain && std::sscanf(copy.c_str(), "%5ux%5u%n", &spec.width_px, &spec.height_px, &end) == 2;
  if (plain && !whole()) {
    end = 0;
    good = std::sscanf(copy.c_str(), "%5ux%5u@%8lf%n", &spec.width_px, &spec.height_px,
                       &spec.refresh_hz, &end) == 3 &&
           whole() && spec.refresh_hz > 0;
  }
  if (good && spec.width_px > 0 && spec.height_px > 0) return spec;
  return std::unexpected("\"" + rt::printable(text) +
                         "\" is no mode: write it as \"1920x1080@59.94\"");
}

bool fulfils(const drmModeModeInfo& mode, const ModeSpec& spec) {
  if (mode.hdisplay != spec.width_px || mode.vdisplay != spec.height_px) return false;
  return spec.refresh_hz <= 0 ||
         std::abs(refreshHz(mode) - spec.refresh_hz) <= kRateTolerance * spec.refresh_hz;
}

bool isMultiple(double refresh_hz, double trigger_hz) {
  if (!(refresh_hz > 0 && trigger_hz > 0)) return false;
  const double times = std::round(refresh_hz / trigger_hz);
  return times >= 1 &&
         std::abs(refresh_hz - times * trigger_hz) <= kTriggerGivesWay * times * trigger_hz;
}

std::vector<drmModeModeInfo> rankModes(std::span<const drmModeModeInfo> modes, double trigger_hz,
                                       const std::optional<ModeSpec>& spec) {
  std::vector<drmModeModeInfo> ranked;
  std::ranges::copy_if(modes, std::back_inserter(ranked), [](const drmModeModeInfo& mode) {
    return mode.hdisplay > 0 && mode.vdisplay > 0 && refreshHz(mode) > 0;
  });
  std::ranges::stable_sort(ranked, [&](const drmModeModeInfo& a, const drmModeModeInfo& b) {
    return rank(a, trigger_hz, spec) < rank(b, trigger_hz, spec);
  });
  return ranked;
}

bool sameTiming(const drmModeModeInfo& a, const drmModeModeInfo& b) {
  const auto timing = [](const drmModeModeInfo& m) {
    return std::tuple(m.clock, m.hdisplay, m.hsync_start, m.hsync_end, m.htotal, m.hskew,
                      m.vdisplay, m.vsync_start, m.vsync_end, m.vtotal, m.vscan, m.flags);
  };
  return timing(a) == timing(b);
}

std::string describe(const drmModeModeInfo& mode) {
  char text[48];
  std::snprintf(text, sizeof text, "%ux%u at %.2f Hz", mode.hdisplay, mode.vdisplay,
                refreshHz(mode));
  return text;
}

}  // namespace ui::kms
