#pragma once

#include "hal/emulated/rig/socket.h"

namespace emulator {

/// SIGINT and SIGTERM then wait for openStopSignals(). First thing in main(): threads that
/// libraries start later inherit it.
void blockStopSignals();

/// Readable once a stop was asked for.
[[nodiscard]] UniqueFd openStopSignals();

}  // namespace emulator
