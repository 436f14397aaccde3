#include "hal/aravis/profile_push.h"

#include <cstdio>
#include <optional>
#include <variant>

#include "hal/aravis/feature_profile.h"
#include "hal/aravis/gobject.h"

namespace hal::aravis {
namespace {

using Outcome = std::optional<std::string>;  // what is wrong, or nothing

std::string shown(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

/// ", it knows Line1, Line2"; empty where the feature has no list of values.
std::string knownValues(ArvDevice* device, const std::string& name) {
  GlibError error;
  guint count = 0;
  const char** values = arv_device_dup_available_enumeration_feature_values_as_strings(
      device, name.c_str(), &count, error.out());
  std::string known;
  for (guint i = 0; values != nullptr && i < count; ++i) {
    known += (i == 0 ? ", it knows " : ", ") + std::string(values[i]);
  }
  g_free(static_cast<void*>(values));
  return known;
}

Outcome set(ArvDevice* device, const std::string& name, const std::string& wanted) {
  GlibError error;
  arv_device_set_string_feature_value(device, name.c_str(), wanted.c_str(), error.out());
  if (error) {
    return "refuses " + name + " = " + wanted + " (" + error.message() + ")" +
           knownValues(device, name);
  }
  const char* got = arv_device_get_string_feature_value(device, name.c_str(), error.out());
  if (error) return "does not report " + name + " (" + error.message() + ")";
  if (got == nullptr || wanted != got) {
    return name + " is " + (got != nullptr ? got : "nothing") + ", wanted " + wanted;
  }
  return std::nullopt;
}

Outcome set(ArvDevice* device, const std::string& name, std::int64_t wanted) {
  GlibError error;
  // A switch is a boolean in some cameras and an integer in others.
  ArvGcNode* node = arv_device_get_feature(device, name.c_str());
  const bool boolean = ARV_IS_GC_BOOLEAN(node);
  if (boolean) {
    arv_device_set_boolean_feature_value(device, name.c_str(), wanted != 0 ? TRUE : FALSE,
                                         error.out());
  } else {
    arv_device_set_integer_feature_value(device, name.c_str(), wanted, error.out());
  }
  if (error)
    return "refuses " + name + " = " + shown(static_cast<double>(wanted)) + " (" + error.message() +
           ")";
  const std::int64_t got =
      boolean ? arv_device_get_boolean_feature_value(device, name.c_str(), error.out())
              : arv_device_get_integer_feature_value(device, name.c_str(), error.out());
  if (error) return "does not report " + name + " (" + error.message() + ")";
  if (got != wanted) {
    return name + " is " + std::to_string(got) + ", wanted " + std::to_string(wanted);
  }
  return std::nullopt;
}

Outcome set(ArvDevice* device, const std::string& name, double wanted) {
  GlibError error;
  arv_device_set_float_feature_value(device, name.c_str(), wanted, error.out());
  if (error) return "refuses " + name + " = " + shown(wanted) + " (" + error.message() + ")";
  const double got = arv_device_get_float_feature_value(device, name.c_str(), error.out());
  if (error) return "does not report " + name + " (" + error.message() + ")";
  if (!inForce(wanted, got)) return name + " is " + shown(got) + ", wanted " + shown(wanted);
  return std::nullopt;
}

/// Whether the camera has the feature at all.
bool has(ArvDevice* device, const std::string& name) {
  GlibError error;
  ArvGcNode* node = arv_device_get_feature(device, name.c_str());
  return ARV_IS_GC_FEATURE_NODE(node) &&
         arv_gc_feature_node_is_implemented(ARV_GC_FEATURE_NODE(node), error.out()) != FALSE;
}

/// Whether it can be used now: what other features are set to may lock it away.
bool isAvailable(ArvDevice* device, const std::string& name) {
  GlibError error;
  return arv_device_is_feature_available(device, name.c_str(), error.out()) != FALSE && !error;
}

}  // namespace

std::expected<void, std::string> pushProfile(ArvCamera* camera, const CameraProfile& profile) {
  ArvDevice* device = arv_camera_get_device(camera);
  const auto fail = [&](const std::string& what) {
    return std::unexpected(profile.name + " (" + profile.address + "): " + what +
                           ": check the camera's model and its [cameras] settings");
  };
  const auto settings = namedFor(featureSettings(profile),
                                 [&](const std::string& name) { return has(device, name); });
  if (!settings) return fail(settings.error());
  for (const FeatureSetting& setting : *settings) {
    if (setting.optional && !isAvailable(device, setting.name)) continue;
    const Outcome wrong = std::visit(
        [&](const auto& wanted) { return set(device, setting.name, wanted); }, setting.value);
    if (wrong) return fail(*wrong);
  }

  // The delay's register counts the camera's own ticks; Aravis knows their length.
  GlibError error;
  arv_camera_gv_set_packet_delay(camera, profile.packet_delay_ns, error.out());
  if (error) return fail("refuses a packet delay (" + error.message() + ")");
  const auto delay_ns = static_cast<double>(arv_camera_gv_get_packet_delay(camera, error.out()));
  if (error || !inForce(profile.packet_delay_ns, delay_ns)) {
    return fail("packet delay is " + shown(delay_ns) + " ns, wanted " +
                std::to_string(profile.packet_delay_ns) + " ns");
  }
  return {};
}

}  // namespace hal::aravis
