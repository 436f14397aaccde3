#include "appliance/control/control_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <set>
#include <utility>
#include <vector>

#include "appliance/control/bus_callbacks.h"
#include "appliance/control/bus_link.h"
#include "appliance/control/bus_values.h"
#include "appliance/control/control_requests.h"
#include "appliance/control/peer_watch.h"
#include "appliance/control/status_properties.h"

namespace appliance {

struct ControlServer::Implementation {
  Implementation(EventLoop& loop, Place place, ControlSink& to, Status first);

  int offer(sd_bus* bus);
  void releaseFor(const std::string& peer);
  void takeBackFrom(const std::string& peer);

  ControlSink& sink;
  Status status;     // of the last tick
  std::string json;  // the same, once somebody asked
  std::vector<sd_bus_vtable> properties;
  std::vector<BusObject> objects;
  std::set<std::string> screen_holders;  // unique names
  PeerWatch peers;
  BusLink link;
};

namespace {

using Server = ControlServer::Implementation;

int busy(sd_bus_error* error) {
  return sd_bus_error_set(error, SD_BUS_ERROR_LIMITS_EXCEEDED,
                          "too many requests wait to be carried out: try again");
}

/// Carries out one request and answers its message.
int answer(Server& server, sd_bus_message* message, const Requested& requested,
           sd_bus_error* error) {
  if (!requested) return refuse(error, requested.error());
  if (*requested && !server.sink.command(**requested)) return busy(error);
  return sd_bus_reply_method_return(message, "");
}

int setMode(Server& server, sd_bus_message* message, sd_bus_error* error) {
  const char* mode = nullptr;
  if (const int r = sd_bus_message_read(message, "s", &mode); r < 0) return r;
  return answer(server, message, requestMode(mode, server.status), error);
}

int setDelay(Server& server, sd_bus_message* message, sd_bus_error* error) {
  std::uint32_t delay_ms = 0;
  if (const int r = sd_bus_message_read(message, "u", &delay_ms); r < 0) return r;
  return answer(server, message, requestDelay(delay_ms, server.status), error);
}

int setView(Server& server, sd_bus_message* message, sd_bus_error* error) {
  std::uint32_t view = 0;
  if (const int r = sd_bus_message_read(message, "u", &view); r < 0) return r;
  return answer(server, message, requestView(view, server.status), error);
}

int setTarget(Server& server, sd_bus_message* message, sd_bus_error* error) {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
  if (const int r = sd_bus_message_read(message, "ddd", &x_m, &y_m, &z_m); r < 0) return r;
  const auto target_m = requestTarget(x_m, y_m, z_m);
  if (!target_m) return refuse(error, target_m.error());
  if (!server.sink.setTarget(*target_m)) return busy(error);
  return sd_bus_reply_method_return(message, "");
}

int releaseTarget(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  server.sink.releaseTarget();
  return sd_bus_reply_method_return(message, "");
}

int freeze(Server& server, sd_bus_message* message, sd_bus_error* error) {
  return answer(server, message, Command{Command::Kind::kFreezeToggle}, error);
}

int sweep(Server& server, sd_bus_message* message, sd_bus_error* error) {
  return answer(server, message, Command{Command::Kind::kSweep}, error);
}

int releaseScreen(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  if (const int r = server.peers.add(message); r < 0) return r;
  const char* sender = sd_bus_message_get_sender(message);
  server.releaseFor(sender != nullptr ? sender : "");
  return sd_bus_reply_method_return(message, "");
}

int takeScreen(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  server.screen_holders.clear();
  server.sink.setScreenReleased(false);
  return sd_bus_reply_method_return(message, "");
}

int statusJson(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  if (server.json.empty()) server.json = toJson(server.status);
  return sd_bus_reply_method_return(message, "s", server.json.c_str());
}

int getProperty(Server& server, const char* name, sd_bus_message* reply) {
  const auto property = std::ranges::find(statusProperties(), std::string_view(name),
                                          [](const auto& each) { return each.name; });
  if (property == statusProperties().end()) return -ENOENT;
  return appendValue(reply, property->value(server.status));
}

// Who may call is the bus's policy (systemd/org.kagami.Kagami1.conf), not sd-bus's own rule.
constexpr std::uint64_t kOpenToAll = SD_BUS_VTABLE_UNPRIVILEGED;

template <int (*kMethod)(Server&, sd_bus_message*, sd_bus_error*)>
constexpr sd_bus_message_handler_t kOn = onMethod<Server, kMethod>;

std::vector<sd_bus_vtable> propertyTable() {
  std::vector<sd_bus_vtable> table = {SD_BUS_VTABLE_START(0)};
  for (const StatusProperty& property : statusProperties()) {
    constexpr sd_bus_property_get_t kGet = onProperty<Server, getProperty>;
    if (property.signals == StatusProperty::Signals::kYes) {
      table.push_back(SD_BUS_PROPERTY(property.name, property.type, kGet, 0,
                                      SD_BUS_VTABLE_PROPERTY_EMITS_CHANGE));
    } else {
      table.push_back(SD_BUS_PROPERTY(property.name, property.type, kGet, 0, 0));
    }
  }
  table.push_back(SD_BUS_METHOD_WITH_ARGS("Status", SD_BUS_NO_ARGS, SD_BUS_RESULT("s", json),
                                          kOn<statusJson>, kOpenToAll));
  table.push_back(SD_BUS_VTABLE_END);
  return table;
}

const auto kControlTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_METHOD_WITH_ARGS("SetMode", SD_BUS_ARGS("s", mode), SD_BUS_NO_RESULT, kOn<setMode>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetDelay", SD_BUS_ARGS("u", delay_ms), SD_BUS_NO_RESULT, kOn<setDelay>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetView", SD_BUS_ARGS("u", view), SD_BUS_NO_RESULT, kOn<setView>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetTarget", SD_BUS_ARGS("d", x_m, "d", y_m, "d", z_m),
                            SD_BUS_NO_RESULT, kOn<setTarget>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("ReleaseTarget", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<releaseTarget>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Freeze", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<freeze>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Sweep", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<sweep>, kOpenToAll),
    SD_BUS_VTABLE_END,
});

const auto kMaintenanceTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_METHOD_WITH_ARGS("ReleaseScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<releaseScreen>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("TakeScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<takeScreen>,
                            kOpenToAll),
    SD_BUS_VTABLE_END,
});

}  // namespace

ControlServer::Implementation::Implementation(EventLoop& loop, Place place, ControlSink& to,
                                              Status first)
    : sink(to),
      status(std::move(first)),
      properties(propertyTable()),
      objects{{kControlPath, kStatusInterface, properties.data(), this},
              {kControlPath, kControlInterface, kControlTable.data(), this},
              {kControlPath, kMaintenanceInterface, kMaintenanceTable.data(), this}},
      peers([this](const std::string& peer) { takeBackFrom(peer); }),
      link(loop, std::move(place.bus), std::move(place.name),
           {.offer = [this](sd_bus* bus) { return offer(bus); },
            .lost = [this] { peers.loseAll(); }}) {}

int ControlServer::Implementation::offer(sd_bus* bus) {
  for (const BusObject& object : objects) {
    const int r = sd_bus_add_object_vtable(bus, nullptr, object.path, object.interface,
                                           object.vtable, object.target);
    if (r < 0) return r;
  }
  return 0;
}

void ControlServer::Implementation::releaseFor(const std::string& peer) {
  screen_holders.insert(peer);
  sink.setScreenReleased(true);
}

void ControlServer::Implementation::takeBackFrom(const std::string& peer) {
  if (screen_holders.erase(peer) == 0 || !screen_holders.empty()) return;
  sink.setScreenReleased(false);
}

ControlServer::ControlServer(EventLoop& loop, Place place, ControlSink& sink, Status first)
    : implementation_(
          std::make_unique<Implementation>(loop, std::move(place), sink, std::move(first))) {}
ControlServer::~ControlServer() = default;

void ControlServer::show(const BusObject& object) {
  implementation_->objects.push_back(object);
}

void ControlServer::tick(rt::Timestamp now, Status status) {
  Implementation& own = *implementation_;
  own.link.look(now);
  std::vector<const char*> changed = changedProperties(own.status, status);
  own.status = std::move(status);
  own.json.clear();
  if (changed.empty() || !connected()) return;
  changed.push_back(nullptr);
  // A failure means a bus that is being lost; the link sees that itself.
  (void)sd_bus_emit_properties_changed_strv(own.link.bus(), kControlPath, kStatusInterface,
                                            const_cast<char**>(changed.data()));
}

bool ControlServer::connected() const {
  return implementation_->link.bus() != nullptr;
}

std::string ControlServer::trouble() const {
  const std::string& why = implementation_->link.trouble();
  if (why.empty()) return why;
  return "no control interface: " + why +
         "; kagami status and remote commands do not work, the rest does; tried again every 5 s";
}

std::string ControlServer::title() const {
  return implementation_->link.title();
}

}  // namespace appliance
