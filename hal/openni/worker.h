#pragma once

#include "hal/openni/device.h"
#include "hal/openni/driver_stage.h"

namespace hal::openni {

/// The process that runs OpenNI2 for a supervisor: looks for the device, opens it and hands its
/// pairs over @p socket, until the device goes, the recording ends or the supervisor does.
///
/// Returns the exit status. What went wrong was said over the socket.
[[nodiscard]] int runWorker(int socket, const DeviceRequest& request, DriverStage stage);

}  // namespace hal::openni
