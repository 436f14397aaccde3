#include "appliance/director/director_settings.h"

#include <algorithm>
#include <functional>

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, DirectorSettings& director) {
  section.numbers("delay_ladder_s", director.delay_ladder_s, {0.01, 3600, "s"});
  section.number("sweep_views_per_s", director.sweep_views_per_s, {0.1, 240, "views/s"});
  section.number("idle_home_s", director.idle_home_s, {0, 86400, "s"});
  section.end();
  const auto& ladder = director.delay_ladder_s;
  if (ladder.empty() || std::ranges::adjacent_find(ladder, std::greater_equal{}) != ladder.end())
    section.fail("delay_ladder_s", "delay_ladder_s must be one or more rising delays");
}

}  // namespace appliance
