#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// One GenICam feature to set, by its standard (SFNC) name.
struct FeatureSetting {
  std::string name;
  std::variant<std::string, std::int64_t, double> value;
  /// A camera without this feature is fine: it has nothing to switch off.
  bool optional = false;
  std::string older_name = {};  ///< of the same feature, before the standard; empty: none
};

/// The profile as settings in the order in which a camera accepts them: the format before
/// the size, automatic functions off before their manual values, the trigger last.
[[nodiscard]] std::vector<FeatureSetting> featureSettings(const CameraProfile& profile);

/// Cameras round to their own increments: what was read back counts as the same within 1 %
/// (of the wish, or of 1 where the wish is smaller).
[[nodiscard]] bool inForce(double wanted, double read_back);

}  // namespace hal::aravis
