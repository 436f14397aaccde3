#include "appliance/control/status_properties.h"

namespace appliance {
namespace {

using Signals = StatusProperty::Signals;

std::string text(std::string_view name) {
  return std::string(name);
}

/// @p reasons: a reason may contain a growing number of seconds, so its text changes at every tick.
std::vector<BusDictionary> cameraTable(const Status& status, bool reasons) {
  std::vector<BusDictionary> table;
  for (const CameraStatus& camera : status.cameras) {
    BusDictionary row = {{"Name", camera.name},
                         {"State", text(nameOf(camera.state))},
                         {"Trouble", text(nameOf(camera.trouble))},
                         {"FramesLost", camera.frames_lost},
                         {"FramesAway", camera.frames_away},
                         {"FramesIncomplete", camera.frames_incomplete}};
    if (reasons) row.emplace_back("Reason", camera.reason);
    table.push_back(std::move(row));
  }
  return table;
}

BusValue degradedLines(const Status& status) {
  std::vector<std::string> lines;
  for (const Remark& remark : status.degraded) lines.push_back(remark.text);
  return lines;
}

BusValue degradedWithoutNumbers(const Status& status) {
  std::vector<std::string> lines;
  for (const Remark& remark : status.degraded) lines.push_back(withoutNumbers(remark.text));
  return lines;
}

constexpr auto kTable = std::to_array<StatusProperty>({
    {"Mode", "s", [](const Status& s) -> BusValue { return text(nameOf(s.mode)); }},
    {"View", "u", [](const Status& s) -> BusValue { return s.view_wanted + 1; }},
    {"ViewShown", "u", [](const Status& s) -> BusValue { return s.view_shown + 1; }},
    // A stopped moment falls behind with every trigger.
    {"DelayMs", "u", [](const Status& s) -> BusValue { return s.delay_ms; }, Signals::kNo},
    {"HistoryMs", "u", [](const Status& s) -> BusValue { return s.history_ms; }, Signals::kNo},
    {"Target", "(ddd)", [](const Status& s) -> BusValue { return s.target_m; }, Signals::kNo},
    {"TargetOrigin", "s", [](const Status& s) -> BusValue { return s.target_origin; }},
    {"Triggers", "t", [](const Status& s) -> BusValue { return s.triggers; }, Signals::kNo},
    {"FramesLost", "t", [](const Status& s) -> BusValue { return s.frames_lost; }},
    {"FramesAway", "t", [](const Status& s) -> BusValue { return s.frames_away; }, Signals::kNo},
    {"FramesIncomplete", "t", [](const Status& s) -> BusValue { return s.frames_incomplete; }},
    {"Cameras", "aa{sv}", [](const Status& s) -> BusValue { return cameraTable(s, true); },
     Signals::kYes, [](const Status& s) -> BusValue { return cameraTable(s, false); }},
    {"Degraded", "as", degradedLines, Signals::kYes, degradedWithoutNumbers},
    {"Renderer", "s", [](const Status& s) -> BusValue { return s.renderer; }},
    {"Screen", "s", [](const Status& s) -> BusValue { return text(nameOf(s.screen)); }},
    {"ScreenMessage", "s", [](const Status& s) -> BusValue { return s.screen_message; }},
    {"Genlock", "s", [](const Status& s) -> BusValue { return text(nameOf(s.genlock.state)); }},
});

}  // namespace

std::span<const StatusProperty> statusProperties() {
  return kTable;
}

const char* typeOf(const BusValue& value) {
  constexpr std::array kTypes = {"u", "t", "d", "s", "as", "(ddd)", "aa{sv}"};
  static_assert(kTypes.size() == std::variant_size_v<BusValue>);
  return kTypes[value.index()];
}

std::vector<const char*> changedProperties(const Status& before, const Status& now) {
  std::vector<const char*> changed;
  for (const StatusProperty& property : kTable) {
    if (property.signals == Signals::kNo) continue;
    const auto essence = property.essence != nullptr ? property.essence : property.value;
    if (essence(before) != essence(now)) changed.push_back(property.name);
  }
  return changed;
}

}  // namespace appliance
