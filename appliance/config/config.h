#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "appliance/config/thread_schedule.h"
#include "hal/pixel_format.h"
#include "hal/resend_policy.h"

namespace appliance {

/// Everything a site sets. The defaults here are the values in the installed
/// appliance/config/kagamid.toml, which documents every key; a test holds the two equal.
struct Config {
  struct Rig {
    std::string file = "/etc/kagami/rig.toml";
    bool operator==(const Rig&) const = default;
  };

  struct Cameras {
    std::string backend = "aravis";
    std::vector<std::string> addresses;  ///< IPv4, in the order of the rig file
    std::string trigger_source = "Line1";
    hal::PixelFormat pixel_format = hal::PixelFormat::kBayerRG8;
    double exposure_us = 1000;
    double gain_db = 0;
    std::array<double, 3> white_balance_rgb{1, 1, 1};
    std::uint32_t packet_size_bytes = 9000;
    std::int32_t packet_delay_ns = -1;  ///< below 0: by the network plan
    std::uint32_t socket_buffer_bytes = 4U << 20;
    std::vector<double> opto_delay_us;  ///< one per camera; empty: all the same
    bool operator==(const Cameras&) const = default;
  };

  /// The cameras' way into this machine.
  struct Network {
    std::uint32_t uplinks = 2;
    double uplink_gbps = 10;
    double camera_link_gbps = 1;
    bool operator==(const Network&) const = default;
  };

  /// Packets that did not arrive; frame_retention_us 0: four fifths of the trigger's period.
  struct Resend {
    hal::ResendPolicy policy{.frame_retention_us = 0};
    std::vector<hal::ModelResendPolicy> models;  ///< for these instead
    bool operator==(const Resend&) const = default;
  };

  /// What lights the hall.
  struct Light {
    double mains_hz = 50;
    bool operator==(const Light&) const = default;
  };

  struct Trigger {
    std::string backend = "emulated";
    double rate_hz = 40;
    double pulse_width_us = 100;
    std::uint32_t wire_port = 3990;  ///< of the emulator, on this machine
    std::vector<std::string> lines;  ///< GPIO lines by name
    bool active_low = false;
    std::string loopback_line;  ///< empty: the trigger's edges are not measured
    bool loopback_active_low = false;
    bool genlock = true;              ///< in phase with the screen where the rates allow it
    double genlock_margin_us = 1500;  ///< frame_ready to the latest start of its warp
    bool operator==(const Trigger&) const = default;
  };

  struct History {
    std::uint32_t sets = 300;
    std::uint32_t in_flight = 8;  ///< slots per camera
    bool size_down = true;
    bool operator==(const History&) const = default;
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
    double zoom = 1;
    std::uint32_t render_threads = 2;
    std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    bool flicker_compensation = false;
    bool operator==(const Display&) const = default;
  };

  struct Panel {
    std::string backend = "none";
    std::string script;
    std::string button_prefix = "button-";
    std::string lamp_prefix = "lamp-";
    bool active_low = true;
    std::uint32_t debounce_ms = 10;
    bool operator==(const Panel&) const = default;
  };

  /// What looks at the athlete's distance.
  struct DepthSensor {
    std::string backend = "none";
    std::string source;   ///< empty: the first sensor
    std::string drivers;  ///< folder; empty: the system's
    std::uint32_t width_px = 640;
    std::uint32_t height_px = 480;
    std::uint32_t rate_hz = 30;
    bool colour = true;
    double latency_ms = 40;  ///< from exposure to arrival
    bool repeat = true;      ///< a recording
    bool operator==(const DepthSensor&) const = default;
  };

  struct Director {
    std::vector<double> delay_ladder_s{0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30};
    double sweep_views_per_s = 10;
    bool operator==(const Director&) const = default;
  };

  struct Record {
    std::string directory;  ///< empty: nothing is recorded
    double video_hz = 20;
    std::uint32_t video_width_px = 640;
    bool operator==(const Record&) const = default;
  };

  struct Realtime {
    bool lock_memory = true;
    bool require = false;  ///< refuse to start without the permissions, instead of degrading
    ThreadSchedule trigger{rt::SchedPolicy::kFifo, 80, {}};
    ThreadSchedule receive{rt::SchedPolicy::kFifo, 70, {}};
    ThreadSchedule render{rt::SchedPolicy::kFifo, 75, {}};
    ThreadSchedule draw{rt::SchedPolicy::kFifo, 74, {}};  ///< workers of a software renderer
    ThreadSchedule panel{};
    bool operator==(const Realtime&) const = default;
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
  Cameras cameras;
  Network network;
  Resend resend;
  Light light;
  Trigger trigger;
  History history;
  Display display;
  Panel panel;
  DepthSensor depth_sensor;
  Director director;
  Record record;
  Realtime realtime;
  State state;
  Control control;
  std::vector<std::string> warnings;  ///< what was read and has no effect, one line each
  bool operator==(const Config&) const = default;
};

/// The defaults, then the file's keys, then @p overrides: "section.key=value" with the value as
/// in TOML; a value that is not TOML is taken as text, so that a shell needs no second quotes.
///
/// Errors   One line for a person: file and line (or the override), what, what to do. A key that
///          does not exist is refused, with the nearest one that does.
[[nodiscard]] std::expected<Config, std::string> loadConfig(
    const std::string& path, const std::vector<std::string>& overrides = {});

/// The same of text already read; @p name stands for the file in messages.
[[nodiscard]] std::expected<Config, std::string> parseConfig(
    std::string_view text, const std::string& name, const std::vector<std::string>& overrides = {});

/// Every key there is, as "section.key".
[[nodiscard]] std::vector<std::string> configKeys();

}  // namespace appliance
