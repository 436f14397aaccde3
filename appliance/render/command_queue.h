#pragma once

#include "appliance/director/command.h"
#include "rt/clock.h"
#include "rt/spsc_ring.h"

namespace appliance {

/// A command and when the person gave it.
struct CommandEvent {
  Command command;
  rt::Timestamp at;
};

/// More than a person can press between two pictures.
inline constexpr std::uint32_t kMostCommands = 64;

/// From one commanding thread to the render thread. A full queue refuses and counts.
using CommandQueue = rt::SpscRing<CommandEvent, kMostCommands>;

}  // namespace appliance
