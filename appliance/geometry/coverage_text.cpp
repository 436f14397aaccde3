#include "appliance/geometry/coverage_text.h"

#include <array>
#include <cstdio>
#include <utility>

namespace appliance {
namespace {

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 256> line{};
  (void)std::snprintf(line.data(), line.size(), pattern, arguments...);
  return line.data();
}

std::string titleOf(const Rig& rig, std::size_t camera) {
  return "camera " + std::to_string(camera + 1) + " (" + rig.cameras[camera].name + ")";
}

std::string lineOf(const Rig& rig, std::size_t camera, double needed, const ViewParameters& shown) {
  ViewParameters at_zoom_1 = shown;
  at_zoom_1.zoom = 1;
  const RigCamera& of = rig.cameras[camera];
  const double filled = filledPart(of, viewOf(of, rig, rig.target_m, at_zoom_1), at_zoom_1);
  const double used = usedPart(of, viewOf(of, rig, rig.target_m, shown), shown);
  const std::string needs = needed > 0 ? format("%.2f", needed) : "no sight";
  return format("%4zu %-16.16s %14s %17.0f %% %16.0f %%", camera + 1, of.name.c_str(),
                needs.c_str(), 100 * filled, 100 * used);
}

}  // namespace

std::vector<std::string> coverLines(const Rig& rig, std::uint32_t width_px, std::uint32_t height_px,
                                    std::optional<double> fixed_zoom) {
  const CoverZoom cover = coverZoom(rig, width_px, height_px);
  const ViewParameters shown{
      .width_px = width_px, .height_px = height_px, .zoom = fixed_zoom.value_or(cover.zoom)};
  std::vector<std::string> lines;
  lines.push_back(format("screen of %ux%u: zoom %.2f%s, \"cover\" is %.2f", width_px, height_px,
                         shown.zoom, fixed_zoom ? " as configured" : "", cover.zoom));
  lines.push_back(format("%4s %-16s %14s %19s %18s", "view", "camera", "zoom to cover",
                         "filled at zoom 1", "picture shown"));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    lines.push_back(lineOf(rig, i, cover.needed[i], shown));
  if (const Phrase warning = coverWarning(rig, cover.worst, cover.needed[cover.worst]);
      !warning.empty())
    lines.push_back(textOf(warning));
  return lines;
}

Phrase coverWarning(const Rig& rig, std::uint32_t worst, double needed_zoom) {
  if (!(needed_zoom > kMostCoverZoom)) return {};
  return phrase<Word::kViewZoom>(titleOf(rig, worst), needed_zoom, kMostCoverZoom);
}

Phrase blindWarning(const Rig& rig, std::size_t camera) {
  return phrase<Word::kViewBlind>(titleOf(rig, camera));
}

}  // namespace appliance
