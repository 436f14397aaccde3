#include "appliance/control/control_server.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "appliance/control/bus.h"
#include "appliance/control/control_requests.h"

namespace appliance {

struct ControlServer::Implementation {
  ControlSink& sink;
  const StatusSource& source;
  Bus bus;
  std::string bus_name;  // for messages
};

namespace {

using Server = ControlServer::Implementation;

int refuse(sd_bus_error* error, const std::string& why) {
  return sd_bus_error_set(error, SD_BUS_ERROR_INVALID_ARGS, why.c_str());
}

int busy(sd_bus_error* error) {
  return sd_bus_error_set(error, SD_BUS_ERROR_LIMITS_EXCEEDED,
                          "too many requests wait to be carried out: try again");
}

/// Carries out one request and answers its message.
int answer(sd_bus_message* message, Server& server, const Requested& requested,
           sd_bus_error* error) {
  if (!requested) return refuse(error, requested.error());
  if (*requested && !server.sink.command(**requested)) return busy(error);
  return sd_bus_reply_method_return(message, "");
}

Server& serverOf(void* userdata) {
  return *static_cast<Server*>(userdata);
}

int onSetMode(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  const char* mode = nullptr;
  if (const int r = sd_bus_message_read(message, "s", &mode); r < 0) return r;
  Server& server = serverOf(userdata);
  return answer(message, server, requestMode(mode, server.source.status()), error);
}

int onSetDelay(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  std::uint32_t delay_ms = 0;
  if (const int r = sd_bus_message_read(message, "u", &delay_ms); r < 0) return r;
  Server& server = serverOf(userdata);
  return answer(message, server, requestDelay(delay_ms, server.source.status()), error);
}

int onSetView(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  std::uint32_t view = 0;
  if (const int r = sd_bus_message_read(message, "u", &view); r < 0) return r;
  Server& server = serverOf(userdata);
  return answer(message, server, requestView(view, server.source.status()), error);
}

int onSetTarget(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
  if (const int r = sd_bus_message_read(message, "ddd", &x_m, &y_m, &z_m); r < 0) return r;
  const auto target_m = requestTarget(x_m, y_m, z_m);
  if (!target_m) return refuse(error, target_m.error());
  if (!serverOf(userdata).sink.setTarget(*target_m)) return busy(error);
  return sd_bus_reply_method_return(message, "");
}

int onReleaseTarget(sd_bus_message* message, void* userdata, sd_bus_error* /*error*/) {
  serverOf(userdata).sink.releaseTarget();
  return sd_bus_reply_method_return(message, "");
}

int onFreeze(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  return answer(message, serverOf(userdata), Command{Command::Kind::kFreezeToggle}, error);
}

int onSweep(sd_bus_message* message, void* userdata, sd_bus_error* error) {
  return answer(message, serverOf(userdata), Command{Command::Kind::kSweep}, error);
}

template <bool kReleased>
int onScreen(sd_bus_message* message, void* userdata, sd_bus_error* /*error*/) {
  serverOf(userdata).sink.setScreenReleased(kReleased);
  return sd_bus_reply_method_return(message, "");
}

int onStatus(sd_bus_message* message, void* userdata, sd_bus_error* /*error*/) {
  return sd_bus_reply_method_return(message, "s",
                                    toJson(serverOf(userdata).source.status()).c_str());
}

int appendCameras(sd_bus_message* reply, const Status& status) {
  if (const int r = sd_bus_message_open_container(reply, 'a', "(sstt)"); r < 0) return r;
  for (const CameraStatus& camera : status.cameras) {
    const int r = sd_bus_message_append(reply, "(sstt)", camera.name.c_str(),
                                        std::string(nameOf(camera.state)).c_str(),
                                        camera.frames_lost, camera.frames_incomplete);
    if (r < 0) return r;
  }
  return sd_bus_message_close_container(reply);
}

int appendCameraReasons(sd_bus_message* reply, const Status& status) {
  if (const int r = sd_bus_message_open_container(reply, 'a', "s"); r < 0) return r;
  for (const CameraStatus& camera : status.cameras)
    if (const int r = sd_bus_message_append(reply, "s", camera.reason.c_str()); r < 0) return r;
  return sd_bus_message_close_container(reply);
}

int appendDegraded(sd_bus_message* reply, const Status& status) {
  if (const int r = sd_bus_message_open_container(reply, 'a', "s"); r < 0) return r;
  for (const Remark& remark : status.degraded)
    if (const int r = sd_bus_message_append(reply, "s", remark.text.c_str()); r < 0) return r;
  return sd_bus_message_close_container(reply);
}

/// What one property appends to its reply.
using Append = int (*)(sd_bus_message* reply, const Status& status);

template <Append kAppend>
int onGet(sd_bus* /*bus*/, const char* /*path*/, const char* /*interface*/,
          const char* /*property*/, sd_bus_message* reply, void* userdata,
          sd_bus_error* /*error*/) {
  return kAppend(reply, serverOf(userdata).source.status());
}

constexpr Append kMode = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "s", std::string(nameOf(status.mode)).c_str());
};
constexpr Append kView = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "u", status.view_wanted + 1);
};
constexpr Append kViewShown = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "u", status.view_shown + 1);
};
constexpr Append kDelay = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "u", status.delay_ms);
};
constexpr Append kHistory = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "u", status.history_ms);
};
constexpr Append kTarget = [](sd_bus_message* reply, const Status& status) {
  const auto& target_m = status.target_m;
  return sd_bus_message_append(reply, "(ddd)", target_m[0], target_m[1], target_m[2]);
};
constexpr Append kShownHz = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "d", status.shown_hz);
};
constexpr Append kTriggers = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "t", status.triggers);
};
constexpr Append kFramesLost = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "t", status.frames_lost);
};
constexpr Append kFramesIncomplete = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "t", status.frames_incomplete);
};
constexpr Append kRenderer = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "s", status.renderer.c_str());
};

constexpr Append kScreen = [](sd_bus_message* reply, const Status& status) {
  return sd_bus_message_append(reply, "s", std::string(nameOf(status.screen)).c_str());
};

// Who may call is the bus's policy (systemd/org.kagami.Kagami1.conf), not sd-bus's own rule.
constexpr std::uint64_t kOpenToAll = SD_BUS_VTABLE_UNPRIVILEGED;

const auto kVtable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_PROPERTY("Mode", "s", onGet<kMode>, 0, 0),
    SD_BUS_PROPERTY("View", "u", onGet<kView>, 0, 0),
    SD_BUS_PROPERTY("ViewShown", "u", onGet<kViewShown>, 0, 0),
    SD_BUS_PROPERTY("DelayMs", "u", onGet<kDelay>, 0, 0),
    SD_BUS_PROPERTY("HistoryMs", "u", onGet<kHistory>, 0, 0),
    SD_BUS_PROPERTY("Target", "(ddd)", onGet<kTarget>, 0, 0),
    SD_BUS_PROPERTY("ShownHz", "d", onGet<kShownHz>, 0, 0),
    SD_BUS_PROPERTY("Triggers", "t", onGet<kTriggers>, 0, 0),
    SD_BUS_PROPERTY("FramesLost", "t", onGet<kFramesLost>, 0, 0),
    SD_BUS_PROPERTY("FramesIncomplete", "t", onGet<kFramesIncomplete>, 0, 0),
    SD_BUS_PROPERTY("Cameras", "a(sstt)", onGet<appendCameras>, 0, 0),
    SD_BUS_PROPERTY("CameraReasons", "as", onGet<appendCameraReasons>, 0, 0),
    SD_BUS_PROPERTY("Degraded", "as", onGet<appendDegraded>, 0, 0),
    SD_BUS_PROPERTY("Renderer", "s", onGet<kRenderer>, 0, 0),
    SD_BUS_PROPERTY("Screen", "s", onGet<kScreen>, 0, 0),
    SD_BUS_METHOD_WITH_ARGS("SetMode", SD_BUS_ARGS("s", mode), SD_BUS_NO_RESULT, onSetMode,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetDelay", SD_BUS_ARGS("u", delay_ms), SD_BUS_NO_RESULT, onSetDelay,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetView", SD_BUS_ARGS("u", view), SD_BUS_NO_RESULT, onSetView,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("SetTarget", SD_BUS_ARGS("d", x_m, "d", y_m, "d", z_m),
                            SD_BUS_NO_RESULT, onSetTarget, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("ReleaseTarget", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, onReleaseTarget,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Freeze", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, onFreeze, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Sweep", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, onSweep, kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("ReleaseScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, onScreen<true>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("TakeScreen", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT, onScreen<false>,
                            kOpenToAll),
    SD_BUS_METHOD_WITH_ARGS("Status", SD_BUS_NO_ARGS, SD_BUS_RESULT("s", json), onStatus,
                            kOpenToAll),
    SD_BUS_VTABLE_END,
});

std::string noControl(const std::string& why) {
  return "no control interface: " + why +
         "; kagami status and remote commands do not work, the rest does";
}

}  // namespace

ControlServer::ControlServer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ControlServer::~ControlServer() = default;

std::expected<std::unique_ptr<ControlServer>, std::string> ControlServer::open(
    const std::string& bus, const std::string& name, ControlSink& sink,
    const StatusSource& source) {
  auto opened = openBus(bus);
  if (!opened) return std::unexpected(noControl(opened.error()));
  auto made = std::make_unique<Implementation>(
      Implementation{sink, source, std::move(*opened), describeBus(bus)});
  sd_bus* raw = made->bus.get();
  int r = sd_bus_add_object_vtable(raw, nullptr, kControlPath, kControlInterface, kVtable.data(),
                                   made.get());
  if (r >= 0) r = sd_bus_request_name(raw, name.c_str(), 0);
  if (r == -EEXIST)
    return std::unexpected(
        noControl(name + " is taken on " + made->bus_name + ": is another kagamid running?"));
  if (r < 0)
    return std::unexpected(noControl("not allowed to be " + name + " on " + made->bus_name + " (" +
                                     std::strerror(-r) +
                                     "): is its policy file installed and the name valid?"));
  return std::unique_ptr<ControlServer>(new ControlServer(std::move(made)));
}

void ControlServer::wait(rt::Nanoseconds timeout) {
  const auto timeout_us = std::chrono::duration_cast<std::chrono::microseconds>(timeout).count();
  // A failure shows in process(), which has the words for it.
  (void)sd_bus_wait(implementation_->bus.get(), static_cast<std::uint64_t>(timeout_us));
}

std::expected<void, std::string> ControlServer::process() {
  for (;;) {
    const int r = sd_bus_process(implementation_->bus.get(), nullptr);
    if (r == 0) return {};
    if (r < 0)
      return std::unexpected(
          noControl("lost " + implementation_->bus_name + " (" + std::strerror(-r) + ")"));
  }
}

}  // namespace appliance
