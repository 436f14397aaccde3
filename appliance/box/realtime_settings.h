#pragma once

#include "appliance/config/thread_schedule.h"

namespace appliance {

class Section;

/// How the threads of the box run.
struct RealtimeSettings {
  bool lock_memory = true;
  bool require = false;  ///< refuse to start without the permissions, instead of degrading
  ThreadSchedule trigger{rt::SchedPolicy::kFifo, 80, {}};
  ThreadSchedule receive{rt::SchedPolicy::kFifo, 70, {}};
  ThreadSchedule render{rt::SchedPolicy::kFifo, 75, {}};
  ThreadSchedule draw{rt::SchedPolicy::kFifo, 74, {}};  ///< workers of a software renderer
  ThreadSchedule panel{};
  bool operator==(const RealtimeSettings&) const = default;
};

/// Reads `[realtime]`.
void read(Section section, RealtimeSettings& realtime);

}  // namespace appliance
