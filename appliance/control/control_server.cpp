#include "appliance/control/control_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "appliance/control/bus_callbacks.h"
#include "appliance/control/bus_link.h"
#include "appliance/control/bus_values.h"
#include "appliance/control/control_requests.h"
#include "appliance/control/job_objects.h"
#include "appliance/control/peer_watch.h"
#include "appliance/control/pending_calls.h"
#include "appliance/control/status_properties.h"

namespace appliance {

namespace {

/// A message that is answered later.
struct MessageRelease {
  void operator()(sd_bus_message* message) const { sd_bus_message_unref(message); }
};
using Message = std::unique_ptr<sd_bus_message, MessageRelease>;

}  // namespace

struct ControlServer::Implementation {
  Implementation(EventLoop& loop, Place place, ControlSink& to, const StatusSource& from,
                 JobRegistry& registry);

  int offer(sd_bus* bus);
  void releaseFor(const std::string& peer);
  void takeBackFrom(const std::string& peer);

  /// Answers @p message once the director has carried out its command.
  int await(sd_bus_message* message, CommandId id);
  void answer(const CommandAnswer& answer);
  void giveUp(rt::Timestamp now);

  ControlSink& sink;
  const StatusSource& source;
  Status status;     // of the last tick
  std::string json;  // the same, made for the first client that asks
  std::vector<sd_bus_vtable> properties;
  std::vector<BusObject> objects;
  std::set<std::string> screen_holders;  // unique names
  PendingCalls<Message> waiting;         // for the director
  std::vector<CommandAnswer> collected;  // since the last tick
  PeerWatch peers;
  JobObjects jobs;
  BusLink link;
};

namespace {

using Server = ControlServer::Implementation;

int busy(sd_bus_error* error) {
  return refuse(error, phrase<Word::kTooManyRequests>());
}

/// The late answer of a method that was refused.
void replyError(sd_bus_message* call, const Phrase& why) {
  (void)sd_bus_reply_method_errorf(call, errorName(why.word).c_str(), "%s", textOf(why).c_str());
}

/// Gives one request to the director, which answers its message after carrying it out.
int answer(Server& server, sd_bus_message* message, const Requested& requested,
           sd_bus_error* error) {
  if (!requested) return refuse(error, requested.error());
  const auto id = server.sink.command(*requested);
  return id ? server.await(message, *id) : busy(error);
}

int setMode(Server& server, sd_bus_message* message, sd_bus_error* error) {
  const char* mode = nullptr;
  if (const int r = sd_bus_message_read(message, "s", &mode); r < 0) return r;
  return answer(server, message, requestMode(mode), error);
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

int setSpeed(Server& server, sd_bus_message* message, sd_bus_error* error) {
  const char* rate = nullptr;
  if (const int r = sd_bus_message_read(message, "s", &rate); r < 0) return r;
  return answer(server, message, requestSpeed(rate), error);
}

int replay(Server& server, sd_bus_message* message, sd_bus_error* error) {
  std::uint32_t delay_ms = 0;
  const char* rate = nullptr;
  if (const int r = sd_bus_message_read(message, "us", &delay_ms, &rate); r < 0) return r;
  return answer(server, message, requestReplay(delay_ms, rate, server.status), error);
}

int compare(Server& server, sd_bus_message* message, sd_bus_error* error) {
  const char* layout = nullptr;
  std::uint32_t view = 0;
  std::uint32_t earlier_ms = 0;
  double share = 0;
  if (const int r = sd_bus_message_read(message, "suud", &layout, &view, &earlier_ms, &share);
      r < 0)
    return r;
  return answer(server, message, requestCompare(layout, view, earlier_ms, share, server.status),
                error);
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
  return answer(server, message, Command{Command::Kind::kFreeze}, error);
}

int thaw(Server& server, sd_bus_message* message, sd_bus_error* error) {
  return answer(server, message, Command{Command::Kind::kThaw}, error);
}

int sweep(Server& server, sd_bus_message* message, sd_bus_error* error) {
  return answer(server, message, Command{Command::Kind::kStartSweep}, error);
}

int releaseScreen(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  const char* sender = sd_bus_message_get_sender(message);
  if (sender == nullptr) return -EINVAL;
  if (const int r = server.peers.add(sd_bus_message_get_bus(message), sender); r < 0) return r;
  server.releaseFor(sender);
  return sd_bus_reply_method_return(message, "");
}

int takeScreen(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  server.screen_holders.clear();
  server.sink.setScreenReleased(false);
  return sd_bus_reply_method_return(message, "");
}

int loadRig(Server& server, sd_bus_message* message, sd_bus_error* error) {
  const char* text = nullptr;
  const char* name = nullptr;
  if (const int r = sd_bus_message_read(message, "ss", &text, &name); r < 0) return r;
  const auto rig_text = requestRig(text);
  if (!rig_text) return refuse(error, rig_text.error());
  const auto loaded = server.sink.loadRig(*rig_text, name);
  if (!loaded) return refuse(error, loaded.error());
  std::string warnings;
  for (const std::string& warning : *loaded) warnings += warning + "\n";
  return sd_bus_reply_method_return(message, "s", warnings.c_str());
}

int statusJson(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  if (server.json.empty()) server.json = toJson(server.status);
  return sd_bus_reply_method_return(message, "s", server.json.c_str());
}

int metricsJson(Server& server, sd_bus_message* message, sd_bus_error* /*error*/) {
  return sd_bus_reply_method_return(message, "s", server.source.metrics().c_str());
}

int getProperty(Server& server, const char* name, sd_bus_message* reply) {
  const auto property = std::ranges::find(statusProperties(), std::string_view(name),
                                          [](const auto& each) { return each.name; });
  if (property == statusProperties().end()) return -ENOENT;
  return appendValue(reply, property->value(server.status));
}

constexpr rt::Nanoseconds kDirectorsTime = std::chrono::seconds(1);

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
  table.push_back(SD_BUS_METHOD_WITH_ARGS("GetMetrics", SD_BUS_NO_ARGS, SD_BUS_RESULT("s", json),
                                          kOn<metricsJson>, kOpenToAll));
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
    SD_BUS_METHOD_WITH_ARGS("SetSpeed", SD_BUS_ARGS("s", rate), SD_BUS_NO_RESULT, kOn<setSpeed>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Replay", SD_BUS_ARGS("u", delay_ms, "s", rate), SD_BUS_NO_RESULT,
                            kOn<replay>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Compare",
                            SD_BUS_ARGS("s", layout, "u", view, "u", earlier_ms, "d", share),
                            SD_BUS_NO_RESULT, kOn<compare>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetTarget", SD_BUS_ARGS("d", x_m, "d", y_m, "d", z_m),
                            SD_BUS_NO_RESULT, kOn<setTarget>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("ReleaseTarget", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<releaseTarget>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Freeze", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<freeze>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Thaw", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<thaw>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Sweep", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<sweep>, kOpenToAll),
    SD_BUS_VTABLE_END,
});

const auto kMaintenanceTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_METHOD_WITH_ARGS("ReleaseScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<releaseScreen>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("LoadRig", SD_BUS_ARGS("s", text, "s", name),
                            SD_BUS_RESULT("s", warnings), kOn<loadRig>, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("TakeScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, kOn<takeScreen>,
                            kOpenToAll),
    SD_BUS_VTABLE_END,
});

}  // namespace

ControlServer::Implementation::Implementation(EventLoop& loop, Place place, ControlSink& to,
                                              const StatusSource& from, JobRegistry& registry)
    : sink(to),
      source(from),
      status(from.status()),
      properties(propertyTable()),
      objects{{kControlPath, kStatusInterface, properties.data(), this},
              {kControlPath, kControlInterface, kControlTable.data(), this},
              {kControlPath, kMaintenanceInterface, kMaintenanceTable.data(), this}},
      peers([this, &registry](const std::string& peer) {
        takeBackFrom(peer);
        registry.ownerLeft(peer);
      }),
      jobs(registry, peers),
      link(loop, std::move(place.bus), std::move(place.name),
           {.offer = [this](sd_bus* bus) { return offer(bus); },
            .lost =
                [this] {
                  waiting.clear();
                  peers.loseAll();
                }}) {}

int ControlServer::Implementation::offer(sd_bus* bus) {
  for (const BusObject& object : objects) {
    const int r = sd_bus_add_object_vtable(bus, nullptr, object.path, object.interface,
                                           object.vtable, object.target);
    if (r < 0) return r;
  }
  return jobs.offer(bus);
}

int ControlServer::Implementation::await(sd_bus_message* message, CommandId id) {
  waiting.add(id, rt::now() + kDirectorsTime, Message(sd_bus_message_ref(message)));
  return 1;  // handled; the reply follows
}

void ControlServer::Implementation::answer(const CommandAnswer& answer) {
  const auto call = waiting.take(answer.id);
  if (!call) return;
  const Phrase why = refusalOf(answer.outcome);
  // A failure means a bus that is being lost, and with it the caller.
  if (why.empty())
    (void)sd_bus_reply_method_return(call->get(), "");
  else
    replyError(call->get(), why);
}

void ControlServer::Implementation::giveUp(rt::Timestamp now) {
  for (const Message& call : waiting.takeOverdue(now))
    replyError(call.get(), phrase<Word::kNotApplied>());
}

void ControlServer::Implementation::releaseFor(const std::string& peer) {
  screen_holders.insert(peer);
  sink.setScreenReleased(true);
}

void ControlServer::Implementation::takeBackFrom(const std::string& peer) {
  if (screen_holders.erase(peer) == 0 || !screen_holders.empty()) return;
  sink.setScreenReleased(false);
}

ControlServer::ControlServer(EventLoop& loop, Place place, ControlSink& sink,
                             const StatusSource& source, JobRegistry& jobs)
    : implementation_(
          std::make_unique<Implementation>(loop, std::move(place), sink, source, jobs)) {}
ControlServer::~ControlServer() = default;

void ControlServer::show(const BusObject& object) {
  implementation_->objects.push_back(object);
}

void ControlServer::collectAnswers() {
  Implementation& own = *implementation_;
  while (const auto answer = own.sink.nextAnswer()) own.collected.push_back(*answer);
}

void ControlServer::tick(rt::Timestamp now, Status status) {
  Implementation& own = *implementation_;
  own.link.look(now);
  std::vector<const char*> changed = changedProperties(own.status, status);
  own.status = std::move(status);
  own.json.clear();
  if (!changed.empty() && connected()) {
    changed.push_back(nullptr);
    // A failure means a bus that is being lost; the link sees that itself.
    (void)sd_bus_emit_properties_changed_strv(own.link.bus(), kControlPath, kStatusInterface,
                                              const_cast<char**>(changed.data()));
  }
  own.jobs.tick(own.link.bus());
  for (const CommandAnswer& answer : std::exchange(own.collected, {})) own.answer(answer);
  own.giveUp(now);
}

bool ControlServer::connected() const {
  return implementation_->link.bus() != nullptr;
}

std::string ControlServer::trouble() const {
  const Phrase& why = implementation_->link.trouble();
  return why.empty() ? std::string() : textOf(phrase<Word::kControlMissing>(textOf(why)));
}

std::string ControlServer::title() const {
  return implementation_->link.title();
}

}  // namespace appliance
