#pragma once

#include <cstdint>
#include <expected>
#include <functional>
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
  /// Other names of the same feature in the same unit, used by other firmware.
  std::vector<std::string> other_names = {};
  /// Names of similar features in vendor units: reported, never set.
  std::vector<std::string> lookalikes = {};
};

/// The profile as settings in the order in which a camera accepts them: the format before
/// the size, automatic functions off before their manual values, the trigger last.
[[nodiscard]] std::vector<FeatureSetting> featureSettings(const CameraProfile& profile);

/// The settings under the names that this camera has, less the optional ones that it has not.
/// @p has: whether it has a feature of that name.
///
/// Errors   One line with everything that is missing, and what the camera has instead.
[[nodiscard]] std::expected<std::vector<FeatureSetting>, std::string> namedFor(
    std::vector<FeatureSetting> settings, const std::function<bool(const std::string&)>& has);

/// Cameras round to their own increments: what was read back counts as the same within 1 %
/// (of the wanted value, or of 1 if that is smaller).
[[nodiscard]] bool inForce(double wanted, double read_back);

}  // namespace hal::aravis
