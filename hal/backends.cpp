#include "hal/backends.h"

#include "hal/aravis/aravis_camera.h"
#include "hal/emulated/scripted_panel.h"
#include "hal/emulated/terminal_panel.h"
#include "hal/emulated/trigger_line.h"

namespace hal {
namespace {

std::string unknown(const char* device, std::string_view backend, const char* known) {
  return std::string(device) + ".backend = \"" + std::string(backend) + "\" is not one of " + known;
}

/// A backend's own class, seen as the interface.
template <class Device, class Concrete>
Opened<Device> as(std::expected<std::unique_ptr<Concrete>, std::string> opened) {
  if (!opened) return std::unexpected(std::move(opened.error()));
  return std::move(*opened);
}

}  // namespace

Opened<Camera> openCamera(std::string_view backend, const CameraProfile& profile,
                          const rt::ThreadConfig& receive) {
  if (backend == "aravis") return aravis::openCamera(profile, receive);
  return std::unexpected(unknown("cameras", backend, "\"aravis\""));
}

Opened<TriggerLine> openTriggerLine(std::string_view backend, std::uint16_t wire_port) {
  if (backend == "emulated") return as<TriggerLine>(emulated::EmulatedTriggerLine::open(wire_port));
  return std::unexpected(unknown("trigger", backend, "\"emulated\""));
}

Opened<ButtonPanel> openButtonPanel(std::string_view backend, const std::string& script) {
  if (backend == "terminal") return emulated::TerminalPanel::open();
  if (backend == "scripted") {
    auto panel = emulated::ScriptedPanel::open(script, rt::now());
    if (!panel) return std::unexpected(std::move(panel.error()));
    return std::make_unique<emulated::ScriptedPanel>(std::move(*panel));
  }
  return std::unexpected(unknown("panel", backend, "\"none\", \"scripted\", \"terminal\""));
}

}  // namespace hal
