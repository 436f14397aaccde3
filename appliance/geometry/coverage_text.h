#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "appliance/geometry/coverage.h"
#include "appliance/geometry/rig.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// What `kagami plan` says about the picture on a screen of that size, one line each: the zoom, and
/// for each camera the zoom that it needs, how much of the screen it fills at zoom 1 and how much
/// of its picture is shown. @p fixed_zoom: none: "cover".
[[nodiscard]] std::vector<std::string> coverLines(const Rig& rig, std::uint32_t width_px,
                                                  std::uint32_t height_px,
                                                  std::optional<double> fixed_zoom);

/// Camera @p worst needs @p needed_zoom to cover the screen, which is more than is used. Empty if
/// it is not more.
[[nodiscard]] Phrase coverWarning(const Rig& rig, std::uint32_t worst, double needed_zoom);

/// "camera 7 (cam07) does not have the target in its picture, ..."
[[nodiscard]] Phrase blindWarning(const Rig& rig, std::size_t camera);

}  // namespace appliance
