#include "hal/aravis/feature_profile.h"

#include <algorithm>
#include <cmath>

namespace hal::aravis {

std::vector<FeatureSetting> featureSettings(const CameraProfile& profile) {
  using namespace std::string_literals;
  const auto integer = [](std::uint32_t v) { return std::int64_t{v}; };
  std::vector<FeatureSetting> settings{
      {"AcquisitionMode", "Continuous"s},
      // A rate limit left over from free running would swallow triggers.
      {"AcquisitionFrameRateEnable", std::int64_t{0}, true},
      {"PixelFormat", genicamName(profile.pixel_format)},
      {"OffsetX", std::int64_t{0}, true},
      {"OffsetY", std::int64_t{0}, true},
      {"Width", integer(profile.width_px)},
      {"Height", integer(profile.height_px)},
      {"ExposureAuto", "Off"s, true},
      {"ExposureTime", profile.exposure_us, false, "ExposureTimeAbs"},
      {"GainAuto", "Off"s, true},
      {"Gain", profile.gain_db, profile.gain_db == 0},  // without a gain it is 0 dB
      {"BalanceWhiteAuto", "Off"s, true},
      {"BalanceRatioSelector", "Red"s, true},
      {"BalanceRatio", profile.white_balance_rgb[0], true},
      {"BalanceRatioSelector", "Green"s, true},
      {"BalanceRatio", profile.white_balance_rgb[1], true},
      {"BalanceRatioSelector", "Blue"s, true},
      {"BalanceRatio", profile.white_balance_rgb[2], true},
      {"GevSCPSPacketSize", integer(profile.packet_size_bytes)},
  };
  settings.push_back({"TriggerSelector", "FrameStart"s});
  if (profile.trigger_source == kFreeRunning) {
    settings.push_back({"TriggerMode", "Off"s});
  } else {
    settings.push_back({"TriggerSource", profile.trigger_source});
    settings.push_back({"TriggerActivation", "RisingEdge"s});
    settings.push_back({"TriggerDelay", profile.trigger_delay_us, profile.trigger_delay_us == 0,
                        "TriggerDelayAbs"});
    settings.push_back({"TriggerMode", "On"s});
  }
  return settings;
}

bool inForce(double wanted, double read_back) {
  return std::abs(read_back - wanted) <= 0.01 * std::max(1.0, std::abs(wanted));
}

}  // namespace hal::aravis
