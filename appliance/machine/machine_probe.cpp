#include "appliance/machine/machine_probe.h"

#include <cstdio>
#include <fstream>
#include <numeric>
#include <string>
#include <utility>

#include <sched.h>

#include "appliance/words/phrase.h"
#include "rt/periodic_loop.h"
#include "rt/section.h"

namespace appliance {
namespace {

std::string probeThreadName(std::size_t index) {
  char name[16];
  std::snprintf(name, sizeof name, "probe%02zu", (index + 1) % 100);
  return name;
}

std::vector<int> usableCpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

}  // namespace

bool MachineProbe::start() {
  for (const int cpu : usableCpus()) {
    probes_.push_back(std::make_unique<Probe>());
    probes_.back()->cpu = static_cast<std::uint32_t>(cpu);
    auto started = rt::Thread::start(
        {.name = probeThreadName(probes_.size() - 1),
         .policy = rt::SchedPolicy::kFifo,
         .priority = kPriority,
         .cpus = {cpu}},
        [this, &probe = *probes_.back()](const std::stop_token& stop) { run(probe, stop); });
    if (!started || !started->grant().complete()) {
      stop();
      return false;
    }
    threads_.push_back(std::move(*started));
  }
  return watches();
}

void MachineProbe::stop() {
  for (rt::Thread& thread : threads_) thread.requestStop();
  threads_.clear();
}

void MachineProbe::run(Probe& probe, const std::stop_token& stop) const noexcept {
  const rt::ScopedRtSection rt_section;
  rt::Timestamp due = rt::now() + kPeriod;
  while (!stop.stop_requested()) {
    rt::sleepUntil(due);
    const rt::Timestamp woke = rt::now();
    probe.lateness.add(woke - due);
    if (const auto stall = stallOf(probe.cpu, due, woke, shortest_)) {
      probe.stalls.add();
      (void)probe.ring.tryPush(*stall);
    }
    due = woke - due < kPeriod ? due + kPeriod : woke + kPeriod;
  }
}

std::optional<Stall> MachineProbe::tryPop() {
  for (const auto& probe : probes_) {
    if (const auto stall = probe->ring.tryPop()) return stall;
  }
  return std::nullopt;
}

std::uint64_t MachineProbe::stalls() const {
  return std::accumulate(
      probes_.begin(), probes_.end(), std::uint64_t{0},
      [](std::uint64_t sum, const auto& probe) { return sum + probe->stalls.value(); });
}

std::uint64_t MachineProbe::dropped() const {
  return std::accumulate(
      probes_.begin(), probes_.end(), std::uint64_t{0},
      [](std::uint64_t sum, const auto& probe) { return sum + probe->ring.dropped(); });
}

std::string realTimeThrottle(const std::string& proc) {
  long period_us = 0;
  long runtime_us = 0;
  if (!(std::ifstream(proc + "/sys/kernel/sched_rt_period_us") >> period_us) ||
      !(std::ifstream(proc + "/sys/kernel/sched_rt_runtime_us") >> runtime_us)) {
    return {};
  }
  if (runtime_us < 0 || runtime_us >= period_us) return {};
  return textOf(phrase<Word::kMachineThrottles>((period_us - runtime_us) / 1000, period_us / 1000,
                                                runtime_us));
}

}  // namespace appliance
