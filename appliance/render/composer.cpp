#include "appliance/render/composer.h"

#include <cmath>
#include <cstddef>

namespace appliance {

hal::ViewLayer placed(const hal::WarpPlan& plan, std::uint64_t content, const Place& place,
                      std::uint32_t width_px, std::uint32_t height_px) RT_SAFE {
  const auto width = static_cast<double>(width_px);
  const auto column = [width](float share) {
    return static_cast<std::int32_t>(std::lround(width * static_cast<double>(share)));
  };
  hal::ViewLayer layer{.plan = plan, .opacity = place.opacity, .content = content};
  layer.where = {.x = column(place.left),
                 .y = 0,
                 .width = column(place.right) - column(place.left),
                 .height = static_cast<std::int32_t>(height_px)};
  // What the plan shows at x is to be seen at x + shift.
  const double shift_px = width * (static_cast<double>(place.centre) - 0.5);
  auto& h = layer.plan.H_camera_display;
  for (const std::size_t row : {0U, 3U, 6U}) h[row + 2] -= shift_px * h[row];
  if (shift_px != 0) layer.plan.edge = {};
  return layer;
}

}  // namespace appliance
