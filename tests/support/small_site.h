#pragma once

#include "appliance/site/site.h"

namespace test {

/// A site of two small cameras, which no part opens.
inline appliance::Site smallSite() {
  appliance::Site site;
  for (const char* name : {"left", "right"})
    site.rig.cameras.push_back(
        {.name = name, .width_px = 64, .height_px = 64, .lens = {.fx_px = 60, .fy_px = 60}});
  site.config.history.sets = 8;
  site.config.realtime.lock_memory = false;
  return site;
}

}  // namespace test
