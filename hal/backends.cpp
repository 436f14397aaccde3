#include "hal/backends.h"

#include <utility>

#include "hal/aravis/aravis_camera.h"
#include "hal/aravis/camera_probe.h"
#ifdef KAGAMI_EMULATED
#include "hal/emulated/scripted_panel.h"
#include "hal/emulated/terminal_panel.h"
#include "hal/emulated/trigger_line.h"
#endif
#include "hal/gpiod/edge_input.h"
#include "hal/gpiod/panel.h"
#include "hal/gpiod/trigger_line.h"
#include "hal/openni/folder_sensor.h"
#include "hal/openni/folder_writer.h"
#include "hal/openni/openni_sensor.h"

namespace hal {
namespace {

// A product build has none of the backends for machines without hardware.
#ifdef KAGAMI_EMULATED
constexpr const char* kTriggerBackends = R"("emulated", "gpiod")";
constexpr const char* kPanelBackends = R"("none", "scripted", "terminal", "gpiod")";
#else
constexpr const char* kTriggerBackends = R"("gpiod")";
constexpr const char* kPanelBackends = R"("none", "gpiod")";
#endif

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

CameraProbe probeCamera(std::string_view backend, const std::string& address,
                        rt::Nanoseconds timeout) {
  if (backend == "aravis") return aravis::probeCamera(address, timeout);
  return {};
}

Opened<TriggerLine> openTriggerLine(std::string_view backend, const TriggerLineSettings& settings) {
#ifdef KAGAMI_EMULATED
  if (backend == "emulated")
    return as<TriggerLine>(emulated::EmulatedTriggerLine::open(settings.wire_port));
#endif
  if (backend == "gpiod")
    return gpiod::openTriggerLine({.lines = settings.lines, .active_low = settings.active_low});
  return std::unexpected(unknown("trigger", backend, kTriggerBackends));
}

Opened<EdgeInput> openEdgeInput(const std::string& line, bool active_low) {
  return gpiod::openEdgeInput({.line = line, .active_low = active_low});
}

Opened<ButtonPanel> openButtonPanel(std::string_view backend, const PanelSettings& settings,
                                    std::vector<std::string>& notes) {
#ifdef KAGAMI_EMULATED
  if (backend == "terminal") return emulated::TerminalPanel::open();
  if (backend == "scripted") {
    auto panel = emulated::ScriptedPanel::open(settings.script, rt::now());
    if (!panel) return std::unexpected(std::move(panel.error()));
    return std::make_unique<emulated::ScriptedPanel>(std::move(*panel));
  }
#endif
  if (backend == "gpiod") {
    auto opened = gpiod::openButtonPanel(settings);
    if (!opened) return std::unexpected(std::move(opened.error()));
    for (std::string& note : opened->notes) notes.push_back(std::move(note));
    return std::move(opened->panel);
  }
  return std::unexpected(unknown("panel", backend, kPanelBackends));
}

Opened<DepthSensor> openDepthSensor(std::string_view backend, const DepthSensorSettings& settings) {
  if (backend == "openni") {
    return as<DepthSensor>(openni::OpenniSensor::open(settings));
  }
  if (backend == "folder") {
    return as<DepthSensor>(
        openni::FolderSensor::open({.folder = settings.source, .repeat = settings.repeat}));
  }
  return std::unexpected(unknown("depth_sensor", backend, R"("none", "openni", "folder")"));
}

std::unique_ptr<DepthRecorder> makeDepthRecorder(const std::string& folder) {
  return std::make_unique<openni::FolderWriter>(folder, openni::ColourFile::kPng);
}

}  // namespace hal
