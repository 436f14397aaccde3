#pragma once

#include <expected>
#include <memory>
#include <string>

#include "hal/camera.h"
#include "hal/camera_profile.h"
#include "rt/thread.h"

namespace hal::aravis {

/// Opens the GigE Vision camera at profile.address, pushes the whole profile and reads it
/// back. Blocks: some milliseconds, half a second where nobody answers, seconds where a camera
/// dies meanwhile; as does the camera's destructor.
///
/// Threads  Any, several cameras at once: one that is dead does not delay the others.
///
/// @p receive is applied to the thread on which the camera's frames arrive; where that is not
/// permitted the thread runs as it is (listTasks() shows it).
///
/// Errors   One line: which camera, what it refused or reported instead, what to do.
[[nodiscard]] std::expected<std::unique_ptr<Camera>, std::string> openCamera(
    const CameraProfile& profile, const rt::ThreadConfig& receive);

}  // namespace hal::aravis
