#pragma once

#include <string>

#include "hal/camera_probe.h"
#include "rt/clock.h"

namespace hal::aravis {

/// Asks the camera at @p address (IPv4) who controls it, by reading its registers over a socket of
/// its own: one question of GigE Vision's control protocol, and two more where it is held. Opens
/// nothing, changes nothing, and needs no camera to be there.
///
/// Threads  Any.
/// RT       Not safe: waits for the answer, never longer than @p timeout.
[[nodiscard]] CameraProbe probeCamera(const std::string& address, rt::Nanoseconds timeout);

}  // namespace hal::aravis
