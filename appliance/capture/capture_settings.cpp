#include "appliance/capture/capture_settings.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include <arpa/inet.h>

#include "appliance/config/section.h"

namespace appliance {
namespace {

constexpr std::array<std::string_view, 5> kPixelFormats = {"BayerRG8", "BayerGB8", "BayerGR8",
                                                           "BayerBG8", "Mono8"};
bool isIpv4(const std::string& text) {
  in_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
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

}  // namespace

void read(Section section, CamerasSettings& cameras) {
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

void read(Section section, ResendSettings& resend) {
  readPolicy(section, resend.policy);
  ConfigReading not_listed;
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

void read(Section section, TriggerSettings& trigger) {
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

void read(Section section, HistorySettings& history) {
  section.integer("sets", history.sets, {2, 60'000, "frame sets"});  // kMostSlots, and the others
  section.integer("in_flight", history.in_flight, {2, 64, "slots"});
  section.retired("reserve", "each reader of the history has its own slots");
  section.flag("size_down", history.size_down);
  section.end();
}

}  // namespace appliance
