#pragma once

#include <expected>
#include <memory>
#include <string>

#include "hal/camera.h"
#include "hal/camera_profile.h"
#include "rt/thread.h"

namespace hal::aravis {

/// Opens the GigE Vision camera at profile.address, pushes the whole profile and reads it
/// back. Blocks for some milliseconds, for half a second if no camera answers, and for seconds if
/// the camera dies meanwhile. The camera's destructor blocks likewise.
///
/// Threads  Any, several cameras in parallel: one that is dead does not delay the others.
///
/// @p receive is applied to the thread on which the camera's frames arrive; where that is not
/// permitted the thread runs as it is (listTasks() shows it).
///
/// Errors   One line: which camera, what it refused or reported instead, what to do.
[[nodiscard]] std::expected<std::unique_ptr<Camera>, std::string> openCamera(
    const CameraProfile& profile, const rt::ThreadConfig& receive);

}  // namespace hal::aravis
