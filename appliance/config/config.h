#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "appliance/box/realtime_settings.h"
#include "appliance/box/state_settings.h"
#include "appliance/capture/capture_settings.h"
#include "appliance/control/control_settings.h"
#include "appliance/depth/depth_settings.h"
#include "appliance/director/director_settings.h"
#include "appliance/light/light_settings.h"
#include "appliance/network/network_settings.h"
#include "appliance/panel/panel_settings.h"
#include "appliance/record/record_settings.h"
#include "appliance/render/display_settings.h"
#include "appliance/site/rig_settings.h"

namespace appliance {

/// Everything a site sets. The folder that uses a setting owns its struct and reads it. The
/// defaults there are the values in the installed appliance/config/kagamid.toml, which documents
/// every key; a test holds the two equal.
struct Config {
  RigSettings rig;
  CamerasSettings cameras;
  NetworkSettings network;
  ResendSettings resend;
  LightSettings light;
  TriggerSettings trigger;
  HistorySettings history;
  DisplaySettings display;
  PanelSettings panel;
  DepthSettings depth_sensor;
  DirectorSettings director;
  RecordSettings record;
  RealtimeSettings realtime;
  StateSettings state;
  ControlSettings control;
  std::vector<std::string> warnings;  ///< what was read and has no effect, one line each
  bool operator==(const Config&) const = default;
};

/// Calls @p visit with the name and the settings of each section, in the order of the installed
/// file. The folder of the settings has their read(Section, Settings&).
template <class Visitor>
void visitSections(Config& config, Visitor&& visit) {
  visit("rig", config.rig);
  visit("cameras", config.cameras);
  visit("network", config.network);
  visit("resend", config.resend);
  visit("light", config.light);
  visit("trigger", config.trigger);
  visit("history", config.history);
  visit("display", config.display);
  visit("panel", config.panel);
  visit("depth_sensor", config.depth_sensor);
  visit("director", config.director);
  visit("record", config.record);
  visit("realtime", config.realtime);
  visit("state", config.state);
  visit("control", config.control);
}

/// The defaults, then the file's keys, then @p overrides: "section.key=value" with the value as
/// in TOML; a value that is not TOML is taken as text, so that a shell needs no second quotes.
///
/// Errors   One line for a person: file and line (or the override), what, what to do. A key that
///          does not exist is ignored with a warning (another version may have written it); in an
///          override it is refused. Both name the nearest one that exists.
[[nodiscard]] std::expected<Config, std::string> loadConfig(
    const std::string& path, const std::vector<std::string>& overrides = {});

/// The same of text already read; @p name stands for the file in messages.
[[nodiscard]] std::expected<Config, std::string> parseConfig(
    std::string_view text, const std::string& name, const std::vector<std::string>& overrides = {});

/// Every key there is, as "section.key".
[[nodiscard]] std::vector<std::string> configKeys();

}  // namespace appliance
