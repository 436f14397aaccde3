#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rt/thread.h"

namespace appliance {

/// How one thread, or all receive threads, run; rt::ThreadConfig less its name.
struct ThreadSchedule {
  rt::SchedPolicy policy = rt::SchedPolicy::kOther;
  int priority = 0;
  std::vector<int> cpus;  ///< empty: any
  bool operator==(const ThreadSchedule&) const = default;
};

[[nodiscard]] inline rt::ThreadConfig threadConfig(std::string name, const ThreadSchedule& how) {
  return {
      .name = std::move(name), .policy = how.policy, .priority = how.priority, .cpus = how.cpus};
}

}  // namespace appliance
