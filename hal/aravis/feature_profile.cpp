#include "hal/aravis/feature_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace hal::aravis {

std::vector<FeatureSetting> featureSettings(const CameraProfile& profile) {
  using namespace std::string_literals;
  const auto integer = [](std::uint32_t v) { return std::int64_t{v}; };
  std::vector<FeatureSetting> settings{
      {"AcquisitionMode", "Continuous"s},
      // A rate limit left over from free running would swallow triggers.
      {"AcquisitionFrameRateEnable", std::int64_t{0}, true, {"AcquisitionFrameRateEnabled"}},
      {"PixelFormat", genicamName(profile.pixel_format)},
      {"OffsetX", std::int64_t{0}, true},
      {"OffsetY", std::int64_t{0}, true},
      {"Width", integer(profile.width_px)},
      {"Height", integer(profile.height_px)},
      {"ExposureAuto", "Off"s, true},
      {"ExposureMode", "Timed"s, true},  // by its time, not by the trigger's width
      {"ExposureTime",
       profile.exposure_us,
       false,
       {"ExposureTimeAbs"},
       {"ExposureTimeRaw", "ExposureValue", "Shutter", "IntegrationTime"}},
      {"GainAuto", "Off"s, true},
      // Without a gain it is 0 dB.
      {"Gain", profile.gain_db, profile.gain_db == 0, {"GainAbs"}, {"GainRaw", "GainAll"}},
      {"BalanceWhiteAuto", "Off"s, true},
      {"BalanceRatioSelector", "Red"s, true},
      {"BalanceRatio", profile.white_balance_rgb[0], true, {"BalanceRatioAbs"}},
      {"BalanceRatioSelector", "Green"s, true},
      {"BalanceRatio", profile.white_balance_rgb[1], true, {"BalanceRatioAbs"}},
      {"BalanceRatioSelector", "Blue"s, true},
      {"BalanceRatio", profile.white_balance_rgb[2], true, {"BalanceRatioAbs"}},
      {"GevSCPSPacketSize", integer(profile.packet_size_bytes)},
  };
  // A camera with one kind of trigger has nothing to select.
  settings.push_back({"TriggerSelector", "FrameStart"s, true});
  if (profile.trigger_source == kFreeRunning) {
    settings.push_back({"TriggerMode", "Off"s});
  } else {
    settings.push_back({"TriggerSource", profile.trigger_source});
    settings.push_back({"TriggerActivation", "RisingEdge"s});
    settings.push_back({"TriggerDelay",
                        profile.trigger_delay_us,
                        profile.trigger_delay_us == 0,
                        {"TriggerDelayAbs"},
                        {"TriggerDelayRaw"}});
    settings.push_back({"TriggerMode", "On"s});
  }
  return settings;
}

namespace {

std::string joined(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

}  // namespace

std::expected<std::vector<FeatureSetting>, std::string> namedFor(
    std::vector<FeatureSetting> settings, const std::function<bool(const std::string&)>& has) {
  std::vector<FeatureSetting> named;
  std::vector<std::string> missing;
  for (FeatureSetting& setting : settings) {
    if (!has(setting.name)) {
      const auto other = std::ranges::find_if(setting.other_names, has);
      if (other == setting.other_names.end()) {
        if (setting.optional) continue;
        std::vector<std::string> alike;
        std::ranges::copy_if(setting.lookalikes, std::back_inserter(alike), has);
        std::string line = setting.name;
        for (const std::string& name : setting.other_names) line += " or " + name;
        if (!alike.empty()) {
          line += " (it has " + joined(alike, ", ") + ", in units that only its maker knows)";
        }
        missing.push_back(std::move(line));
        continue;
      }
      setting.name = *other;
    }
    named.push_back(std::move(setting));
  }
  if (missing.empty()) return named;
  return std::unexpected("its firmware has no " + joined(missing, ", no "));
}

bool inForce(double wanted, double read_back) {
  return std::abs(read_back - wanted) <= 0.01 * std::max(1.0, std::abs(wanted));
}

}  // namespace hal::aravis
