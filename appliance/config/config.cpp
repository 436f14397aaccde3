#include "appliance/config/config.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include <arpa/inet.h>

#include "appliance/config/toml_reader.h"
#include "rt/printable.h"

namespace appliance {
namespace {

/// Reads the keys of one table into their fields, absent ones stay; every key is named once.
class Section {
 public:
  /// @p all collects every key as "section.key".
  Section(TomlTable table, std::string path, std::vector<std::string>& all)
      : table_(std::move(table)), path_(std::move(path)), all_(&all) {}

  [[nodiscard]] Section sub(std::string_view key) {
    own_keys_.push_back(key);
    return {table_.table(key), path_ + std::string(key) + ".", *all_};
  }
  /// The tables of `[[key]]`, in the file's order.
  [[nodiscard]] std::vector<Section> subs(std::string_view key, std::vector<std::string>& keys) {
    own_keys_.push_back(key);
    std::vector<Section> found;
    for (TomlTable& table : table_.tables(key))
      found.push_back({std::move(table), path_ + std::string(key) + ".", keys});
    return found;
  }

  void text(std::string_view key, std::string& value) { value = named(key).textOr(key, value); }
  /// A text that must not be empty.
  void word(std::string_view key, std::string& value) {
    text(key, value);
    if (value.empty()) fail(key, std::string(key) + " must not be empty");
  }
  void texts(std::string_view key, std::vector<std::string>& value) {
    value = named(key).textsOr(key, value);
  }
  void flag(std::string_view key, bool& value) { value = named(key).flagOr(key, value); }
  void number(std::string_view key, double& value, const NumberRange& range) {
    value = named(key).numberOr(key, value, range);
  }
  void numbers(std::string_view key, std::vector<double>& value, const NumberRange& range) {
    value = named(key).numberListOr(key, value, range);
  }
  void integer(std::string_view key, std::uint32_t& value, const IntegerRange& range) {
    value = static_cast<std::uint32_t>(named(key).integerOr(key, value, range));
  }
  void integer(std::string_view key, int& value, const IntegerRange& range) {
    value = static_cast<int>(named(key).integerOr(key, value, range));
  }
  /// One of the names in @p choices, in the order of the values of the enumeration.
  template <class Enum, std::size_t N>
  void choice(std::string_view key, Enum& value, const std::array<std::string_view, N>& choices) {
    const std::string name = named(key).textOr(key, choices[static_cast<std::size_t>(value)]);
    const auto* found = std::ranges::find(choices, name);
    if (found != choices.end()) {
      value = static_cast<Enum>(found - choices.begin());
      return;
    }
    std::string known;
    for (const std::string_view one : choices) known.append(known.empty() ? "" : ", ").append(one);
    fail(key, std::string(key) + " must be one of " + known + ", not \"" + name + "\"");
  }

  [[nodiscard]] TomlTable& named(std::string_view key) {
    own_keys_.push_back(key);
    all_->push_back(path_ + std::string(key));
    return table_;
  }
  void fail(std::string_view key, const std::string& message) const { table_.fail(key, message); }

  /// A key of earlier versions: it is accepted, has no effect, and a line says so.
  void retired(std::string_view key, std::vector<std::string>& warnings, const char* because) {
    own_keys_.push_back(key);
    if (!table_.has(key)) return;
    warnings.push_back(path_ + std::string(key) + " has no effect any more (" + because +
                       "): remove it from the configuration");
  }

  /// After the last key: every other one is refused.
  void end() const { table_.allowKeys(own_keys_); }

 private:
  TomlTable table_;
  std::string path_;
  std::vector<std::string>* all_;
  std::vector<std::string_view> own_keys_;
};

constexpr std::array<std::string_view, 5> kPixelFormats = {"BayerRG8", "BayerGB8", "BayerGR8",
                                                           "BayerBG8", "Mono8"};
constexpr std::array<std::string_view, 3> kPolicies = {"other", "fifo", "rr"};

bool isIpv4(const std::string& text) {
  in_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

void readCameras(Section section, Config::Cameras& cameras) {
  section.word("backend", cameras.backend);
  section.texts("addresses", cameras.addresses);
  section.word("trigger_source", cameras.trigger_source);
  section.choice("pixel_format", cameras.pixel_format, kPixelFormats);
  section.number("exposure_us", cameras.exposure_us, {1, 1e6, "us"});
  section.number("gain_db", cameras.gain_db, {0, 48, "dB"});
  if (TomlTable& table = section.named("white_balance_rgb"); table.has("white_balance_rgb"))
    cameras.white_balance_rgb = table.numbers<3>("white_balance_rgb", {0.1, 16});
  section.integer("packet_size_bytes", cameras.packet_size_bytes, {576, 16000, "bytes"});
  section.integer("packet_delay_ns", cameras.packet_delay_ns, {-1, 1'000'000, "ns"});
  section.integer("socket_buffer_bytes", cameras.socket_buffer_bytes,
                  {64 * 1024, 256 * 1024 * 1024, "bytes"});
  section.numbers("opto_delay_us", cameras.opto_delay_us, {0, 1000, "us"});
  section.end();

  std::set<std::string> seen;
  for (const std::string& address : cameras.addresses) {
    if (!isIpv4(address))
      section.fail("addresses", "\"" + address + "\" is not an IPv4 address such as 192.168.1.20");
    if (!seen.insert(address).second)
      section.fail("addresses", address + " stands twice; every camera needs its own address");
  }
}

void readNetwork(Section section, Config::Network& network) {
  section.integer("uplinks", network.uplinks, {1, 64, "uplinks"});
  section.number("uplink_gbps", network.uplink_gbps, {0.1, 400, "Gb/s"});
  section.number("camera_link_gbps", network.camera_link_gbps, {0.1, 100, "Gb/s"});
  section.end();
}

void readPolicy(Section& section, hal::ResendPolicy& policy) {
  section.flag("enabled", policy.enabled);
  // Aravis waits in whole milliseconds, and below one not at all: a receive thread would spin.
  section.integer("packet_timeout_us", policy.packet_timeout_us, {1000, 1'000'000, "us"});
  section.integer("initial_packet_timeout_us", policy.initial_packet_timeout_us,
                  {0, 1'000'000, "us"});
  section.integer("frame_retention_us", policy.frame_retention_us, {0, 1'000'000, "us"});
  section.number("request_ratio", policy.request_ratio, {0, 2});
  if (policy.frame_retention_us != 0 && policy.frame_retention_us < policy.packet_timeout_us)
    section.fail("frame_retention_us",
                 "frame_retention_us must not be below packet_timeout_us: no packet would be "
                 "asked for again");
}

void readResend(Section section, Config::Resend& resend) {
  readPolicy(section, resend.policy);
  std::vector<std::string> not_listed;
  const auto models = section.subs("model", not_listed);
  if (!models.empty()) resend.models.clear();
  for (Section model : models) {
    hal::ModelResendPolicy own{.model = {}, .policy = resend.policy};
    model.word("name", own.model);
    readPolicy(model, own.policy);
    model.end();
    if (std::ranges::find(resend.models, own.model, &hal::ModelResendPolicy::model) !=
        resend.models.end())
      model.fail("name", "\"" + own.model + "\" stands twice; give each model once");
    resend.models.push_back(std::move(own));
  }
  section.end();
}

void readTrigger(Section section, Config::Trigger& trigger) {
  section.word("backend", trigger.backend);
  section.number("rate_hz", trigger.rate_hz, {0.1, 1000, "Hz"});
  section.number("pulse_width_us", trigger.pulse_width_us, {1, 1e6, "us"});
  section.integer("wire_port", trigger.wire_port, {1, 65535});
  section.texts("lines", trigger.lines);
  section.flag("active_low", trigger.active_low);
  section.text("loopback_line", trigger.loopback_line);
  section.flag("loopback_active_low", trigger.loopback_active_low);
  section.flag("genlock", trigger.genlock);
  section.number("genlock_margin_us", trigger.genlock_margin_us, {0, 20000, "us"});
  section.end();
}

void readHistory(Section section, Config::History& history, std::vector<std::string>& warnings) {
  section.integer("sets", history.sets, {2, 60'000, "frame sets"});  // kMostSlots, and the others
  section.integer("in_flight", history.in_flight, {2, 64, "slots"});
  section.retired("reserve", warnings, "each reader of the history has its own slots");
  section.flag("size_down", history.size_down);
  section.end();
}

void readDisplay(Section section, Config::Display& display) {
  section.word("backend", display.backend);
  section.text("device", display.device);
  section.text("mode", display.mode);
  section.integer("queue_depth", display.queue_depth, {1, 2, "pictures"});
  section.integer("width_px", display.width_px, {64, 7680, "px"});
  section.integer("height_px", display.height_px, {64, 4320, "px"});
  section.number("refresh_hz", display.refresh_hz, {1, 480, "Hz"});
  section.integer("rotation_deg", display.rotation_deg, {0, 270, "degrees"});
  if (display.rotation_deg % 90 != 0) {
    section.fail("rotation_deg", "rotation_deg must be 0, 90, 180 or 270");
  }
  section.number("zoom", display.zoom, {0.1, 20});
  section.integer("render_threads", display.render_threads, {1, 64, "threads"});
  section.word("font", display.font);
  section.flag("flicker_compensation", display.flicker_compensation);
  section.end();
}

void readPanel(Section section, Config::Panel& panel) {
  section.word("backend", panel.backend);
  section.text("script", panel.script);
  section.text("button_prefix", panel.button_prefix);
  section.text("lamp_prefix", panel.lamp_prefix);
  section.flag("active_low", panel.active_low);
  section.integer("debounce_ms", panel.debounce_ms, {1, 100, "ms"});
  section.end();
  if (panel.button_prefix == panel.lamp_prefix)
    section.fail("lamp_prefix", "lamp_prefix must differ from button_prefix");
}

void readDepthSensor(Section section, Config::DepthSensor& sensor) {
  section.word("backend", sensor.backend);
  section.text("source", sensor.source);
  section.text("drivers", sensor.drivers);
  section.integer("width_px", sensor.width_px, {64, 4096, "px"});
  section.integer("height_px", sensor.height_px, {64, 4096, "px"});
  section.integer("rate_hz", sensor.rate_hz, {1, 240, "Hz"});
  section.flag("colour", sensor.colour);
  section.number("latency_ms", sensor.latency_ms, {0, 1000, "ms"});
  section.flag("repeat", sensor.repeat);
  section.end();
}

void readDirector(Section section, Config::Director& director) {
  section.numbers("delay_ladder_s", director.delay_ladder_s, {0.01, 3600, "s"});
  section.number("sweep_views_per_s", director.sweep_views_per_s, {0.1, 240, "views/s"});
  section.end();
  const auto& ladder = director.delay_ladder_s;
  if (ladder.empty() || std::ranges::adjacent_find(ladder, std::greater_equal{}) != ladder.end())
    section.fail("delay_ladder_s", "delay_ladder_s must be one or more rising delays");
}

void readRecord(Section section, Config::Record& record) {
  section.text("directory", record.directory);
  section.number("video_hz", record.video_hz, {1, 240, "Hz"});
  section.integer("video_width_px", record.video_width_px, {64, 7680, "px"});
  section.end();
}

void readSchedule(Section section, ThreadSchedule& schedule) {
  section.choice("policy", schedule.policy, kPolicies);
  section.integer("priority", schedule.priority, {0, 99});
  const std::vector<std::int64_t> cpus = section.named("cpus").integerListOr(
      "cpus", {schedule.cpus.begin(), schedule.cpus.end()}, {0, 1023, "(CPU numbers)"});
  schedule.cpus.assign(cpus.begin(), cpus.end());
  section.end();
  const bool realtime = schedule.policy != rt::SchedPolicy::kOther;
  if (realtime && schedule.priority == 0)
    section.fail("priority", "priority must be 1 to 99 under the policies fifo and rr");
  if (!realtime && schedule.priority != 0)
    section.fail("priority", "priority must be 0 under the policy other");
}

void readRealtime(Section section, Config::Realtime& realtime) {
  section.flag("lock_memory", realtime.lock_memory);
  section.flag("require", realtime.require);
  readSchedule(section.sub("trigger"), realtime.trigger);
  readSchedule(section.sub("receive"), realtime.receive);
  readSchedule(section.sub("render"), realtime.render);
  readSchedule(section.sub("draw"), realtime.draw);
  readSchedule(section.sub("panel"), realtime.panel);
  section.end();
}

/// What holds only between keys, whichever layer set them.
void checkTogether(const TomlTable& root, const Config& config) {
  const double period_us = 1e6 / config.trigger.rate_hz;
  if (config.cameras.exposure_us >= period_us)
    root.fail("cameras", "cameras.exposure_us must be shorter than the trigger's period of " +
                             std::to_string(std::lround(period_us)) + " us");
  if (config.trigger.pulse_width_us >= period_us)
    root.fail("trigger", "trigger.pulse_width_us must be shorter than the trigger's period of " +
                             std::to_string(std::lround(period_us)) + " us");
  // An incomplete frame holds its slot, and all that come after it, for the whole retention.
  double retention_us = config.resend.policy.frame_retention_us;
  for (const hal::ModelResendPolicy& model : config.resend.models)
    retention_us = std::max<double>(retention_us, model.policy.frame_retention_us);
  const double periods = std::max(1.0, std::ceil(retention_us / period_us));
  const auto needed = static_cast<std::uint32_t>(periods + 2);
  if (config.history.in_flight < needed)
    root.fail("history", "history.in_flight must be at least " + std::to_string(needed) +
                             " at this trigger rate and resend.frame_retention_us");
}

/// Reads what @p root holds over @p config; every key that exists, in the file's order.
std::vector<std::string> readAll(const TomlTable& root, Config& config) {
  std::vector<std::string> keys;
  Section sections(root, "", keys);
  Section rig = sections.sub("rig");
  rig.word("file", config.rig.file);
  rig.end();
  readCameras(sections.sub("cameras"), config.cameras);
  readNetwork(sections.sub("network"), config.network);
  readResend(sections.sub("resend"), config.resend);
  Section light = sections.sub("light");
  light.number("mains_hz", config.light.mains_hz, {10, 100, "Hz"});
  light.end();
  readTrigger(sections.sub("trigger"), config.trigger);
  readHistory(sections.sub("history"), config.history, config.warnings);
  readDisplay(sections.sub("display"), config.display);
  readPanel(sections.sub("panel"), config.panel);
  readDepthSensor(sections.sub("depth_sensor"), config.depth_sensor);
  readDirector(sections.sub("director"), config.director);
  readRecord(sections.sub("record"), config.record);
  readRealtime(sections.sub("realtime"), config.realtime);
  Section state = sections.sub("state");
  state.word("directory", config.state.directory);
  state.text("trace", config.state.trace);
  state.end();
  Section control = sections.sub("control");
  control.word("bus", config.control.bus);
  control.word("name", config.control.name);
  control.end();
  sections.end();
  return keys;
}

std::string inQuotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      std::array<char, 8> escape{};
      (void)std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(c));
      quoted += escape.data();
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

/// How messages name an override.
std::string nameOf(const std::string& override) {
  return "--set " + rt::printable(override);
}

/// An override as a TOML file of one line.
std::expected<TomlFile, std::string> parseOverride(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, std::min(equals, text.size()));
  const bool plain = std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
  if (equals == std::string::npos || !plain || key.find('.') == std::string::npos)
    return std::unexpected(nameOf(text) + ": not of the form section.key=value");
  const std::string value = text.substr(equals + 1);
  const std::string name = nameOf(text);
  if (value.find('\n') == std::string::npos)
    if (auto file = TomlFile::parse(key + " = " + value, name)) return file;
  return TomlFile::parse(key + " = " + inQuotes(value), name);
}

/// A line number says nothing about a command line.
std::string withoutLine(std::string message, const std::string& name) {
  const std::string place = name + ":1:";
  if (message.starts_with(place)) message.replace(0, place.size(), name + ":");
  return message;
}

std::expected<Config, std::string> configOf(TomlFile file,
                                            const std::vector<std::string>& overrides) {
  Config config;
  (void)readAll(file.root(), config);
  if (file.fault()) return std::unexpected(*file.fault());
  for (const std::string& text : overrides) {
    const auto layer = parseOverride(text);
    if (!layer) return std::unexpected(withoutLine(layer.error(), nameOf(text)));
    (void)readAll(layer->root(), config);
    if (layer->fault()) return std::unexpected(withoutLine(*layer->fault(), nameOf(text)));
  }
  checkTogether(file.root(), config);
  if (file.fault()) return std::unexpected(*file.fault());
  return config;
}

}  // namespace

std::vector<std::string> configKeys() {
  Config config;
  const auto empty = TomlFile::parse("", "");
  return readAll(empty->root(), config);
}

std::expected<Config, std::string> loadConfig(const std::string& path,
                                              const std::vector<std::string>& overrides) {
  auto file = TomlFile::load(path);
  if (!file) return std::unexpected(file.error());
  return configOf(std::move(*file), overrides);
}

std::expected<Config, std::string> parseConfig(std::string_view text, const std::string& name,
                                               const std::vector<std::string>& overrides) {
  auto file = TomlFile::parse(text, name);
  if (!file) return std::unexpected(file.error());
  return configOf(std::move(*file), overrides);
}

}  // namespace appliance
