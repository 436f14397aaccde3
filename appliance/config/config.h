#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "appliance/box/realtime_settings.h"
#include "appliance/capture/capture_settings.h"
#include "appliance/depth/depth_settings.h"
#include "appliance/light/light_settings.h"
#include "appliance/network/network_settings.h"
#include "appliance/panel/panel_settings.h"

namespace appliance {

/// Everything a site sets. A folder that has settings owns their struct; what stands here belongs
/// to the box as a whole. The defaults here are the values in the installed
/// appliance/config/kagamid.toml, which documents every key; a test holds the two equal.
struct Config {
  struct Rig {
    std::string file = "/etc/kagami/rig.toml";
    bool operator==(const Rig&) const = default;
  };

  struct Display {
    std::string backend = "offscreen";
    std::string device;  ///< empty: the first card with a screen
    std::string mode;    ///< "1920x1080@59.94"; empty: the best for the trigger rate
    std::uint32_t queue_depth = 1;
    std::uint32_t width_px = 1280;
    std::uint32_t height_px = 720;
    double refresh_hz = 80;
    std::uint32_t rotation_deg = 0;  ///< how far the screen is turned, clockwise
    std::optional<double> zoom;      ///< none: "cover", the smallest that leaves no border
    std::uint32_t render_threads = 2;
    std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    bool flicker_compensation = false;
    bool operator==(const Display&) const = default;
  };

  struct Director {
    std::vector<double> delay_ladder_s{0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30};
    double sweep_views_per_s = 10;
    double idle_home_s = 0;  ///< 0: never
    bool operator==(const Director&) const = default;
  };

  struct Record {
    std::string directory;  ///< empty: nothing is recorded
    double video_hz = 20;
    std::uint32_t video_width_px = 640;
    bool operator==(const Record&) const = default;
  };

  struct State {
    std::string directory = "/var/lib/kagami";
    std::string trace;  ///< empty: no trace is written
    bool operator==(const State&) const = default;
  };

  struct Control {
    std::string bus = "system";  ///< system, session, none or a D-Bus address
    std::string name = "org.kagami.Kagami1";
    bool operator==(const Control&) const = default;
  };

  Rig rig;
  CamerasSettings cameras;
  NetworkSettings network;
  ResendSettings resend;
  LightSettings light;
  TriggerSettings trigger;
  HistorySettings history;
  Display display;
  PanelSettings panel;
  DepthSettings depth_sensor;
  Director director;
  Record record;
  RealtimeSettings realtime;
  State state;
  Control control;
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
