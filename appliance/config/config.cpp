#include "appliance/config/config.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "appliance/config/section.h"
#include "rt/printable.h"

namespace appliance {
namespace {

/// The rules between several keys. They apply to the final values, from whichever layer they came.
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

/// Reads the keys of @p root into @p config, in the file's order; keys that it lacks keep their
/// values.
std::vector<std::string> readAll(const TomlTable& root, Config& config, bool typed) {
  ConfigReading reading{.typed = typed};
  Section sections(root, "", reading);
  visitSections(config,
                [&](std::string_view name, auto& settings) { read(sections.sub(name), settings); });
  sections.end();
  for (std::string& warning : reading.warnings) config.warnings.push_back(std::move(warning));
  return std::move(reading.keys);
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
  (void)readAll(file.root(), config, false);
  if (file.fault()) return std::unexpected(*file.fault());
  config.warnings.insert(config.warnings.end(), file.warnings().begin(), file.warnings().end());
  for (const std::string& text : overrides) {
    const auto layer = parseOverride(text);
    if (!layer) return std::unexpected(withoutLine(layer.error(), nameOf(text)));
    (void)readAll(layer->root(), config, true);
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
  return readAll(empty->root(), config, false);
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
