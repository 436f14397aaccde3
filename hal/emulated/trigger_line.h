#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>

#include "hal/trigger_line.h"

namespace hal::emulated {

/// Pulls Line1 of the emulated cameras: each edge is one datagram on the emulator's trigger
/// wire, "L1+ <ns>" or "L1- <ns>" with the instant it left.
///
/// Threads  As hal::TriggerLine.
/// RT       setActive(): formats into a fixed buffer and makes one send that does not block.
/// Errors   kDeviceLost when nothing listened to an earlier edge; kBusy when the kernel has no
///          room. This edge did not leave then.
class EmulatedTriggerLine final : public TriggerLine {
 public:
  /// Connects to the wire on 127.0.0.1:@p port and leaves the line inactive.
  [[nodiscard]] static std::expected<std::unique_ptr<EmulatedTriggerLine>, std::string> open(
      std::uint16_t port);
  ~EmulatedTriggerLine() override;
  EmulatedTriggerLine(const EmulatedTriggerLine&) = delete;
  EmulatedTriggerLine& operator=(const EmulatedTriggerLine&) = delete;

  [[nodiscard]] rt::Result<TriggerEdge> setActive(bool active) RT_SAFE override;

 private:
  explicit EmulatedTriggerLine(int fd) : fd_(fd) {}

  int fd_;
  bool active_ = false;
};

}  // namespace hal::emulated
