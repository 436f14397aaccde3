#include "appliance/tools/status_text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace appliance {
namespace {

/// One line per section that has one, under the same column as the core's lines.
std::string sectionLines(const nlohmann::ordered_json& sections) {
  constexpr std::size_t kColumn = 9;
  std::string text;
  for (const auto& [key, section] : sections.items()) {
    const std::string line = section.at("line").get<std::string>();
    if (line.empty()) continue;
    std::string label = key;
    label.resize(std::max(label.size() + 1, kColumn), ' ');
    text += label + line + "\n";
  }
  return text;
}

}  // namespace

std::expected<std::string, std::string> statusText(const std::string& json) {
  const auto status = nlohmann::ordered_json::parse(json, nullptr, false);
  try {
    std::array<char, 768> head{};
    const int view = status.at("view_wanted").get<int>();
    const int shown = status.at("view_shown").get<int>();
    const std::string substitute =
        view == shown ? "" : " (view " + std::to_string(shown) + " shown instead)";
    (void)std::snprintf(
        head.data(), head.size(),
        "mode     %s, %.3f s behind live, %.1f s stored\n"
        "view     %d of %zu%s\n"
        "target   %.3f %.3f %.3f m, %s\n"
        "shown    %.1f frame sets a second, by %s\n"
        "source   %s\n"
        "frames   %llu triggers; %llu frames lost, %llu incomplete, %llu of cameras that were "
        "away\n",
        status.at("mode").get<std::string>().c_str(), status.at("delay_ms").get<double>() / 1e3,
        status.at("history_ms").get<double>() / 1e3, view, status.at("cameras").size(),
        substitute.c_str(), status.at("target_m").at(0).get<double>(),
        status.at("target_m").at(1).get<double>(), status.at("target_m").at(2).get<double>(),
        status.value("target_origin", "").c_str(), status.at("shown_hz").get<double>(),
        status.at("renderer").get<std::string>().c_str(),
        status.at("source_path").get<std::string>().c_str(),
        status.at("triggers").get<unsigned long long>(),
        status.at("frames_lost").get<unsigned long long>(),
        status.at("frames_incomplete").get<unsigned long long>(),
        status.at("frames_away").get<unsigned long long>());
    std::string text = head.data();
    const std::string message = status.at("screen").at("message").get<std::string>();
    text += "screen   " + status.at("screen").at("state").get<std::string>() +
            (message.empty() ? "" : ": " + message) + "\n";
    text += "genlock  " + status.at("genlock").at("text").get<std::string>();
    const auto unlocks = status.at("genlock").at("unlocks").get<std::uint64_t>();
    if (unlocks > 0)
      text += "; lost " + std::to_string(unlocks) + " times, the last by " +
              status.at("genlock").at("last_unlock").get<std::string>();
    text += "\n";
    text += sectionLines(status.at("sections"));
    int number = 0;
    for (const auto& camera : status.at("cameras")) {
      ++number;
      const auto state = camera.at("state").get<std::string>();
      const auto reason = camera.at("reason").get<std::string>();
      const auto lost = camera.at("frames_lost").get<std::uint64_t>();
      const auto incomplete = camera.at("frames_incomplete").get<std::uint64_t>();
      const auto away = camera.at("frames_away").get<std::uint64_t>();
      if (state == "streaming" && lost + incomplete + away == 0) continue;
      text += "camera " + std::to_string(number) + " (" + camera.at("name").get<std::string>() +
              "): " + state + (reason.empty() ? "" : ": " + reason) + "; " + std::to_string(lost) +
              " lost, " + std::to_string(incomplete) + " incomplete, " + std::to_string(away) +
              " while away\n";
    }
    for (const auto& line : status.at("degraded"))
      text += "degraded: " + line.get<std::string>() + "\n";
    return text;
  } catch (const nlohmann::json::exception&) {
    return std::unexpected("kagamid's status cannot be read: is kagami of the same version?");
  }
}

}  // namespace appliance
