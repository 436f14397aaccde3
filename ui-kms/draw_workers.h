#pragma once

#include <vector>

#include "rt/thread.h"

namespace ui {

/// How the workers of a software renderer shall run; rt::ThreadConfig less its name.
struct DrawWorkerSchedule {
  rt::SchedPolicy policy = rt::SchedPolicy::kOther;
  int priority = 0;
  std::vector<int> cpus;  ///< each worker gets one of them in turn; empty: of all of the process
};

/// Names and schedules the worker threads with which Mesa's llvmpipe draws for this process:
/// draw01, draw02 ... Nothing to do, and true, where a GPU draws.
///
/// The fair scheduler leaves two of them on one CPU when the other one was busy for a moment,
/// and a picture then takes twice as long: each gets a CPU of its own.
///
/// Threads  After the EGL context was made, before the first picture.
/// Errors   false: not everything was permitted; they draw all the same.
[[nodiscard]] bool scheduleDrawWorkers(const DrawWorkerSchedule& how);

}  // namespace ui
