#pragma once

#include <vector>

namespace appliance {

class Section;

/// What a site sets of the director.
struct DirectorSettings {
  std::vector<double> delay_ladder_s{0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30};
  double sweep_views_per_s = 10;
  double idle_home_s = 0;  ///< 0: never
  bool operator==(const DirectorSettings&) const = default;
};

/// Reads `[director]`.
void read(Section section, DirectorSettings& director);

}  // namespace appliance
