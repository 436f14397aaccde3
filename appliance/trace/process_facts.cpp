#include "appliance/trace/process_facts.h"

#include <cstdio>

#include <sys/resource.h>
#include <unistd.h>

#include "rt/thread.h"

namespace appliance {

std::vector<TracedThread> tracedThreads() {
  std::vector<TracedThread> threads;
  for (const rt::TaskInfo& task : rt::listTasks()) {
    threads.push_back({.name = task.name,
                       .policy = task.policy == rt::SchedPolicy::kFifo         ? "fifo"
                                 : task.policy == rt::SchedPolicy::kRoundRobin ? "rr"
                                                                               : "other",
                       .priority = task.priority,
                       .cpu = task.cpus.size() == 1 ? task.cpus.front() : -1});
  }
  return threads;
}

double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t residentBytes() {
  std::uint64_t pages = 0;
  std::uint64_t resident = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(statm, "%lu %lu", &pages, &resident) != 2) resident = 0;
    (void)std::fclose(statm);
  }
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace appliance
