#include "appliance/control/control_client.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace appliance {
namespace {

/// sd-bus's error and reply, given back whatever happens.
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

template <class... Arguments>
std::expected<std::string, std::string> ControlClient::call(const char* interface,
                                                            const char* method, const char* types,
                                                            Arguments... arguments) {
  Exchange exchange;
  const int r = sd_bus_call_method(bus_.get(), name_.c_str(), kControlPath, interface, method,
                                   &exchange.error, &exchange.reply, types, arguments...);
  if (r < 0) {
    if (sd_bus_error_has_name(&exchange.error, SD_BUS_ERROR_SERVICE_UNKNOWN) != 0 ||
        sd_bus_error_has_name(&exchange.error, SD_BUS_ERROR_NAME_HAS_NO_OWNER) != 0)
      return std::unexpected("kagamid is not running, or has lost " + bus_name_ +
                             " and tries again each 5 s (no " + name_ +
                             " there): systemctl status kagamid; systemctl start kagamid");
    if (sd_bus_error_has_name(&exchange.error, SD_BUS_ERROR_ACCESS_DENIED) != 0)
      return std::unexpected(
          std::string(method) + " is not permitted on " + bus_name_ +
          ": be root, or join the group kagami-operators (to operate) or kagami-viewers "
          "(to look)");
    return std::unexpected(exchange.error.message != nullptr ? exchange.error.message
                                                             : std::strerror(-r));
  }
  const char* text = "";
  if (sd_bus_message_has_signature(exchange.reply, "s") != 0 &&
      sd_bus_message_read(exchange.reply, "s", &text) < 0)
    return std::unexpected("kagamid's answer cannot be read");
  return std::string(text);
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

std::expected<std::string, std::string> ControlClient::status() {
  return call(kStatusInterface, "Status", "");
}

std::expected<std::string, std::string> ControlClient::metrics() {
  return call(kStatusInterface, "GetMetrics", "");
}

}  // namespace appliance
