#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/button_panel.h"
#include "hal/camera.h"
#include "hal/camera_probe.h"
#include "hal/camera_profile.h"
#include "hal/depth_recorder.h"
#include "hal/depth_sensor.h"
#include "hal/edge_input.h"
#include "hal/trigger_line.h"
#include "rt/thread.h"

namespace hal {

/// Makes a device by its backend's name, as the configuration gives it. This is the one place
/// that knows which backends exist.
///
/// Errors   An unknown name lists the known ones; a device that does not open says why.
template <class Device>
using Opened = std::expected<std::unique_ptr<Device>, std::string>;

/// backend "aravis". @p receive: how the camera's receive thread is to run.
[[nodiscard]] Opened<Camera> openCamera(std::string_view backend, const CameraProfile& profile,
                                        const rt::ThreadConfig& receive);

/// Whether a camera answers at @p address and who controls it. Waits no longer than @p timeout; an
/// unknown backend's cameras never answer.
[[nodiscard]] CameraProbe probeCamera(std::string_view backend, const std::string& address,
                                      rt::Nanoseconds timeout);

struct TriggerLineSettings {
  std::uint16_t wire_port = 0;     ///< "emulated": the emulator's trigger wire on this machine
  std::vector<std::string> lines;  ///< "gpiod": names of GPIO lines, which fire together
  bool active_low = false;         ///< "gpiod"
};

/// backend "emulated" or "gpiod".
[[nodiscard]] Opened<TriggerLine> openTriggerLine(std::string_view backend,
                                                  const TriggerLineSettings& settings);

/// A GPIO line by its name, whatever the trigger line's backend.
[[nodiscard]] Opened<EdgeInput> openEdgeInput(const std::string& line, bool active_low);

/// backend "scripted", "terminal" (keys of this terminal) or "gpiod". What opens with less than it
/// could have adds a line for a person to @p notes.
[[nodiscard]] Opened<ButtonPanel> openButtonPanel(std::string_view backend,
                                                  const PanelSettings& settings,
                                                  std::vector<std::string>& notes);

/// backend "openni" or "folder". A missing sensor is no error: the backend keeps searching for it.
[[nodiscard]] Opened<DepthSensor> openDepthSensor(std::string_view backend,
                                                  const DepthSensorSettings& settings);

/// Makes a recording as a folder of pictures at @p folder, which does not exist yet.
[[nodiscard]] std::unique_ptr<DepthRecorder> makeDepthRecorder(const std::string& folder);

}  // namespace hal
