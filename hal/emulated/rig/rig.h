#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/emulated/rig/fault_port.h"
#include "hal/emulated/rig/run_record.h"
#include "hal/emulated/rig/scene.h"
#include "rt/clock.h"
#include "rt/stop_signals.h"

namespace emulator {

struct RigOptions {
  std::uint32_t first_address = 0x7f00'0001;  ///< host order; camera i answers on first + i
  std::uint16_t wire_port = 3990;
  double link_bits_per_second = 1e9;
  std::uint32_t max_packet_bytes = 9000;
  std::vector<double> opto_delays_us;  ///< of each camera's Line1; empty: none
  double loss = 0;                     ///< probability that a stream packet is swallowed
  std::uint64_t seed = 1;
  double internal_trigger_hz = 0;  ///< 0: edges come from the wire only
  std::optional<rt::Nanoseconds> run_for;
  rt::Nanoseconds warm_up{0};                    ///< not held against the run: RunRecord
  int realtime_priority = 0;                     ///< SCHED_FIFO; 0: ordinary scheduling
  std::string wire_log;                          ///< file; empty: none
  std::uint16_t fault_port = kDefaultFaultPort;  ///< on first_address; 0: none
  std::string fault_log;                         ///< file; empty: none
};

/// N cameras and their trigger wire, served by one thread until it is stopped.
class Rig {
 public:
  /// Opens every socket and the wire log; the first that fails names itself.
  [[nodiscard]] static std::expected<Rig, std::string> open(Scene& scene,
                                                            const RigOptions& options);
  Rig(Rig&&) noexcept;
  Rig& operator=(Rig&&) noexcept;
  ~Rig();

  /// Serves until @p stop or the end of the run time.
  [[nodiscard]] std::expected<void, std::string> run(const rt::StopSignals& stop);

  [[nodiscard]] const RunRecord& record() const;
  /// Mean time between rising edges; zero with fewer than two.
  [[nodiscard]] rt::Nanoseconds triggerPeriod() const;

 private:
  struct State;
  explicit Rig(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace emulator
