#include "ui-kms/draw_workers.h"

#include <cstdio>
#include <string>

namespace ui {
namespace {

std::string drawThreadName(std::size_t worker) {
  char name[16];
  (void)std::snprintf(name, sizeof name, "draw%02zu", (worker + 1) % 100);
  return name;
}

}  // namespace

bool scheduleDrawWorkers(const DrawWorkerSchedule& how) {
  bool granted = true;
  std::size_t worker = 0;
  for (const rt::TaskInfo& task : rt::listTasks()) {
    if (!task.name.starts_with("llvmpipe-")) continue;
    const std::vector<int>& cpus = how.cpus.empty() ? task.cpus : how.cpus;
    const auto applied = rt::applyToTask(task.tid, {.name = drawThreadName(worker),
                                                    .policy = how.policy,
                                                    .priority = how.priority,
                                                    .cpus = {cpus[worker % cpus.size()]}});
    granted = granted && applied && applied->complete();
    ++worker;
  }
  return granted;
}

}  // namespace ui
