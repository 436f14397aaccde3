#include "appliance/status/status.h"

#include <nlohmann/json.hpp>

namespace appliance {

std::string_view nameOf(hal::ScreenState state) {
  constexpr std::array<std::string_view, 3> kNames = {"showing", "no screen", "released"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string withoutNumbers(std::string_view line) {
  std::string rest;
  const std::size_t colon = line.find(':');
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool digit = line[i] >= '0' && line[i] <= '9';
    if (!digit || i < colon) rest += line[i];
  }
  return rest;
}

namespace {

nlohmann::ordered_json genlockObject(const Status& status) {
  const GenlockStatus& genlock = status.genlock;
  const auto us = [](rt::Nanoseconds time) { return static_cast<double>(time.count()) / 1e3; };
  return {{"state", nameOf(genlock.state)},
          {"reason", nameOf(genlock.reason)},
          {"text", status.genlock_text},
          {"hold_over", genlock.hold_over},
          {"vblanks_per_trigger", genlock.vblanks_per_trigger},
          {"phase_error_us", us(genlock.phase_error)},
          {"phase_error_rms_us", genlock.phase_error_rms_ns / 1e3},
          {"lead_ms", us(genlock.lead) / 1e3},
          {"unlocks", genlock.unlocks},
          {"last_unlock", nameOf(genlock.last_unlock)}};
}

nlohmann::ordered_json sectionObject(const StatusSection& section) {
  nlohmann::ordered_json object = {{"line", section.line}};
  for (const StatusValue& value : section.values)
    std::visit([&](const auto& held) { object[value.name] = held; }, value.value);
  return object;
}

}  // namespace

std::string toJson(const Status& status) {
  nlohmann::ordered_json object = {
      {"mode", nameOf(status.mode)},
      {"view_wanted", status.view_wanted + 1},
      {"view_shown", status.view_shown + 1},
      {"delay_ms", status.delay_ms},
      {"history_ms", status.history_ms},
      {"target_m", status.target_m},
      {"target_origin", status.target_origin},
      {"shown_hz", status.shown_hz},
      {"triggers", status.triggers},
      {"frames_lost", status.frames_lost},
      {"frames_away", status.frames_away},
      {"frames_incomplete", status.frames_incomplete},
      {"frames_unattributed", status.frames_unattributed},
      {"pictures_skipped", status.pictures_skipped},
      {"cameras", nlohmann::ordered_json::array()},
      {"genlock", genlockObject(status)},
      {"sections", nlohmann::ordered_json::object()},
      {"degraded", nlohmann::ordered_json::array()},
      {"renderer", status.renderer},
      {"screen",
       {{"state", nameOf(status.screen)},
        {"message", status.screen_message},
        {"message_id", idOf(status.screen_word)}}},
      {"source_path", status.source_path},
  };
  for (const CameraStatus& camera : status.cameras) {
    object["cameras"].push_back({{"name", camera.name},
                                 {"state", nameOf(camera.state)},
                                 {"reason", camera.reason},
                                 {"reason_id", idOf(camera.reason_word)},
                                 {"frames_lost", camera.frames_lost},
                                 {"frames_away", camera.frames_away},
                                 {"frames_incomplete", camera.frames_incomplete}});
  }
  for (const StatusSection& section : status.sections)
    object["sections"][section.key] = sectionObject(section);
  for (const Remark& remark : status.degraded) object["degraded"].push_back(remark.text);
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace appliance
