#include "appliance/control/control_client.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "appliance/control/bus_object.h"

namespace appliance {
namespace {

/// sd-bus's error and reply, released in every case.
struct Exchange {
  Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  ~Exchange() {
    sd_bus_error_free(&error);
    sd_bus_message_unref(reply);
  }
  sd_bus_error error = SD_BUS_ERROR_NULL;
  sd_bus_message* reply = nullptr;
};

constexpr const char* kNoDepthSensor =
    "this box runs without a depth sensor: see kagami status, and depth_sensor.backend in "
    "kagamid.toml";
constexpr const char* kNoSuchJob = "kagamid does not know that job any more: was it started again?";

ControlClient::Answer withoutReply(const std::expected<std::string, std::string>& called) {
  if (!called) return std::unexpected(called.error());
  return {};
}

}  // namespace

ControlClient::ControlClient(Bus bus, std::string bus_name, std::string name)
    : bus_(std::move(bus)), bus_name_(std::move(bus_name)), name_(std::move(name)) {}

std::expected<ControlClient, std::string> ControlClient::open(const std::string& bus,
                                                              const std::string& name) {
  auto opened = openBus(bus);
  if (!opened) return std::unexpected(opened.error() + ": is its dbus-daemon running?");
  return ControlClient(std::move(*opened), describeBus(bus), name);
}

std::string ControlClient::reasonOf(const sd_bus_error& error, int result, const char* method,
                                    const Object& object) const {
  if (sd_bus_error_has_name(&error, SD_BUS_ERROR_UNKNOWN_OBJECT) != 0) return object.missing;
  if (sd_bus_error_has_name(&error, SD_BUS_ERROR_SERVICE_UNKNOWN) != 0 ||
      sd_bus_error_has_name(&error, SD_BUS_ERROR_NAME_HAS_NO_OWNER) != 0)
    return "kagamid is not running, or has lost " + bus_name_ + " and tries again each 5 s (no " +
           name_ + " there): systemctl status kagamid; systemctl start kagamid";
  if (sd_bus_error_has_name(&error, SD_BUS_ERROR_ACCESS_DENIED) != 0)
    return std::string(method) + " is not permitted on " + bus_name_ +
           ": be root, or join the group kagami-operators (to operate) or kagami-viewers (to look)";
  return error.message != nullptr ? error.message : std::strerror(-result);
}

template <class... Arguments>
std::expected<std::string, std::string> ControlClient::callAt(const Object& object,
                                                              const char* interface,
                                                              const char* method, const char* types,
                                                              Arguments... arguments) {
  Exchange exchange;
  const int r = sd_bus_call_method(bus_.get(), name_.c_str(), object.path, interface, method,
                                   &exchange.error, &exchange.reply, types, arguments...);
  if (r < 0) return std::unexpected(reasonOf(exchange.error, r, method, object));
  const char* text = "";
  for (const char type : {'s', 'o'}) {
    const std::array<char, 2> signature = {type, '\0'};
    if (sd_bus_message_has_signature(exchange.reply, signature.data()) != 0 &&
        sd_bus_message_read_basic(exchange.reply, type, static_cast<void*>(&text)) < 0)
      return std::unexpected("kagamid's answer cannot be read");
  }
  return std::string(text);
}

template <class... Arguments>
std::expected<std::string, std::string> ControlClient::call(const char* interface,
                                                            const char* method, const char* types,
                                                            Arguments... arguments) {
  return callAt({kControlPath, "kagamid offers nothing"}, interface, method, types, arguments...);
}

ControlClient::Answer ControlClient::setMode(const std::string& mode) {
  return withoutReply(call(kControlInterface, "SetMode", "s", mode.c_str()));
}
ControlClient::Answer ControlClient::setDelay(std::uint32_t delay_ms) {
  return withoutReply(call(kControlInterface, "SetDelay", "u", delay_ms));
}
ControlClient::Answer ControlClient::setView(std::uint32_t view) {
  return withoutReply(call(kControlInterface, "SetView", "u", view));
}
ControlClient::Answer ControlClient::setSpeed(const std::string& rate) {
  return withoutReply(call(kControlInterface, "SetSpeed", "s", rate.c_str()));
}
ControlClient::Answer ControlClient::replay(std::uint32_t delay_ms, const std::string& rate) {
  return withoutReply(call(kControlInterface, "Replay", "us", delay_ms, rate.c_str()));
}
ControlClient::Answer ControlClient::compare(const std::string& layout, std::uint32_t view,
                                             std::uint32_t earlier_ms, double share) {
  return withoutReply(
      call(kControlInterface, "Compare", "suud", layout.c_str(), view, earlier_ms, share));
}

ControlClient::Answer ControlClient::setTarget(const std::array<double, 3>& target_m) {
  return withoutReply(
      call(kControlInterface, "SetTarget", "ddd", target_m[0], target_m[1], target_m[2]));
}
ControlClient::Answer ControlClient::releaseTarget() {
  return withoutReply(call(kControlInterface, "ReleaseTarget", ""));
}
ControlClient::Answer ControlClient::freeze() {
  return withoutReply(call(kControlInterface, "Freeze", ""));
}
ControlClient::Answer ControlClient::thaw() {
  return withoutReply(call(kControlInterface, "Thaw", ""));
}
ControlClient::Answer ControlClient::sweep() {
  return withoutReply(call(kControlInterface, "Sweep", ""));
}
ControlClient::Answer ControlClient::releaseScreen() {
  return withoutReply(call(kMaintenanceInterface, "ReleaseScreen", ""));
}
ControlClient::Answer ControlClient::takeScreen() {
  return withoutReply(call(kMaintenanceInterface, "TakeScreen", ""));
}

std::expected<std::string, std::string> ControlClient::loadRig(const std::string& text,
                                                               const std::string& name) {
  return call(kMaintenanceInterface, "LoadRig", "ss", text.c_str(), name.c_str());
}

std::expected<std::string, std::string> ControlClient::snapshotDepth(std::uint32_t pairs) {
  return callAt({kDepthPath, kNoDepthSensor}, kDepthInterface, "Snapshot", "u", pairs);
}

std::expected<JobReport, std::string> ControlClient::job(const std::string& path) {
  Exchange exchange;
  const int r =
      sd_bus_call_method(bus_.get(), name_.c_str(), path.c_str(), "org.freedesktop.DBus.Properties",
                         "GetAll", &exchange.error, &exchange.reply, "s", kJobInterface);
  if (r < 0)
    return std::unexpected(reasonOf(exchange.error, r, "GetAll", {path.c_str(), kNoSuchJob}));
  JobReport report;
  std::string state;
  const auto take = [&](std::string_view name) {
    const char* text = nullptr;
    if (name == "Progress") return sd_bus_message_read(exchange.reply, "v", "d", &report.progress);
    const int read = sd_bus_message_read(exchange.reply, "v", "s", &text);
    if (read > 0 && name == "State") state = text;
    if (read > 0 && name == "Result") report.result = text;
    return read;
  };
  int read = sd_bus_message_enter_container(exchange.reply, 'a', "{sv}");
  while (read >= 0 && (read = sd_bus_message_enter_container(exchange.reply, 'e', "sv")) > 0) {
    const char* name = nullptr;
    read = sd_bus_message_read(exchange.reply, "s", &name);
    if (read > 0) read = take(name);
    if (read > 0) read = sd_bus_message_exit_container(exchange.reply);
  }
  const auto known = jobStateOf(state);
  if (read < 0 || !known) return std::unexpected("kagamid's answer cannot be read");
  report.state = *known;
  return report;
}

ControlClient::Answer ControlClient::cancelJob(const std::string& path) {
  return withoutReply(callAt({path.c_str(), kNoSuchJob}, kJobInterface, "Cancel", ""));
}

std::expected<std::string, std::string> ControlClient::status() {
  return call(kStatusInterface, "Status", "");
}

std::expected<std::string, std::string> ControlClient::metrics() {
  return call(kStatusInterface, "GetMetrics", "");
}

}  // namespace appliance
