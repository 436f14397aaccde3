#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <functional>
#include <string>

#include "tests/bench/reception/receiver.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace bench {

/// kagami-emulator with @p cameras cameras, in its own process and with its own CPU time.
class EmulatedRig {
 public:
  static constexpr std::uint16_t kWirePort = 3997;

  EmulatedRig(std::uint32_t cameras, std::uint32_t width_px, std::uint32_t height_px);

  /// Whether its cameras answer; otherwise error() says why.
  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] std::string error() const { return process_.output(); }
  /// What a client needs to know of the first @p cameras of them.
  [[nodiscard]] ReceptionSetup setup(std::uint32_t cameras, double rate_hz) const;

 private:
  test::TemporaryFolder folder_;
  std::uint32_t width_px_;
  std::uint32_t height_px_;
  test::ChildProcess process_;
  bool ready_;
};

/// One contestant, made for one round.
using Contestant = std::function<MadeReceiver(const ReceptionSetup&, appliance::CaptureBoard&)>;

struct RoundResult {
  double cpu_s = 0;  ///< user and system time of this process, the trigger's included
  double wall_s = 0;
  std::uint64_t frames = 0;
  std::uint64_t expected = 0;  ///< triggers times cameras
  std::uint64_t bytes = 0;     ///< of the frames
  std::string stalls;          ///< whether the machine itself stood still; empty: it did not

  /// A contestant that loses frames also saves their cost: such a round compares nothing.
  [[nodiscard]] bool valid() const { return frames * 100 >= expected * 98; }
};

/// Lets @p contestant receive for @p length after a warm-up of a few triggers; the trigger line is
/// pulsed by the product's own loop, the same for every contestant.
[[nodiscard]] std::expected<RoundResult, std::string> runRound(const ReceptionSetup& setup,
                                                               const Contestant& contestant,
                                                               std::chrono::milliseconds length);

}  // namespace bench
