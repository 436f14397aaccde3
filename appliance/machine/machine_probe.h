#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "appliance/machine/stall.h"
#include "rt/counter.h"
#include "rt/duration_window.h"
#include "rt/spsc_ring.h"
#include "rt/thread.h"

namespace appliance {

/// Detects when the machine itself stands still. On each CPU a thread of the highest priority
/// sleeps for one millisecond at a time and measures how late it wakes.
///
/// Threads  start(), stop(), tryPop(), watches(): the owner. The figures: any.
///          The probes are `probe01`..`probeNN`, one for each CPU that the process may use.
/// RT       A probe sleeps, compares two instants, counts.
/// Memory   A ring of stalls for each CPU; a full one refuses the newest and counts it.
class MachineProbe {
 public:
  static constexpr rt::Nanoseconds kPeriod = std::chrono::milliseconds(1);
  static constexpr int kPriority = 90;  ///< above every other thread of docs/real-time.md

  /// @p shortest: what counts as a stall.
  explicit MachineProbe(rt::Nanoseconds shortest) : shortest_(shortest) {}
  ~MachineProbe() { stop(); }
  MachineProbe(const MachineProbe&) = delete;
  MachineProbe& operator=(const MachineProbe&) = delete;

  /// Without the right to its priority a probe would measure other programs, not the machine:
  /// then none runs, and false is the answer.
  [[nodiscard]] bool start();
  void stop();
  /// Whether the probes run.
  [[nodiscard]] bool watches() const { return !threads_.empty(); }

  /// The next stall that was not taken yet, in order for each CPU.
  [[nodiscard]] std::optional<Stall> tryPop();

  [[nodiscard]] std::size_t cpus() const { return probes_.size(); }
  /// How late the probe of a CPU wakes: the wake latency of the highest priority.
  [[nodiscard]] const rt::DurationWindow& lateness(std::size_t index) const {
    return probes_[index]->lateness;
  }
  [[nodiscard]] std::uint64_t stalls() const;
  /// Stalls that found a full ring.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  struct Probe {
    std::uint32_t cpu = 0;
    rt::DurationWindow lateness;
    rt::Counter stalls;
    rt::SpscRing<Stall, 256> ring;
  };

  void run(Probe& probe, const std::stop_token& stop) const noexcept;

  const rt::Nanoseconds shortest_;
  std::vector<std::unique_ptr<Probe>> probes_;
  std::vector<rt::Thread> threads_;
};

/// The kernel stops real-time threads that used more than this share of a CPU's time, for the
/// rest of a second (kernel.sched_rt_runtime_us): one line that says so, empty where it never does.
/// RT  Not safe: reads /proc.
[[nodiscard]] std::string realTimeThrottle(const std::string& proc = "/proc");

}  // namespace appliance
