#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "hal/button_panel.h"
#include "hal/camera.h"
#include "hal/camera_profile.h"
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

/// backend "emulated": @p wire_port is the emulator's trigger wire on this machine.
[[nodiscard]] Opened<TriggerLine> openTriggerLine(std::string_view backend,
                                                  std::uint16_t wire_port);

/// backend "scripted": @p script is its file; "terminal": keys of this terminal.
[[nodiscard]] Opened<ButtonPanel> openButtonPanel(std::string_view backend,
                                                  const std::string& script);

}  // namespace hal
