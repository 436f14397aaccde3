#pragma once

#include <systemd/sd-bus.h>

#include "appliance/control/peer_watch.h"
#include "appliance/jobs/job_registry.h"

namespace appliance {

/// The registry's jobs on the bus: /org/kagami/Kagami1/jobs/N with the interface
/// org.kagami.Kagami1.Job. The owner of a job is watched, because some end with it.
///
/// Threads  The event loop's.
class JobObjects {
 public:
  JobObjects(JobRegistry& jobs, PeerWatch& peers) : jobs_(jobs), peers_(peers) {}
  JobObjects(const JobObjects&) = delete;
  JobObjects& operator=(const JobObjects&) = delete;

  /// Adds the objects to a bus. Returns a negative errno of sd-bus.
  [[nodiscard]] int offer(sd_bus* bus);

  /// Polls the jobs, and signals on @p bus what changed; null: no bus.
  void tick(sd_bus* bus);

 private:
  JobRegistry& jobs_;
  PeerWatch& peers_;
};

}  // namespace appliance
