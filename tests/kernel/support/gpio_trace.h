#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace test {

/// One access to a line as the kernel's tracepoint gpio_value saw it.
struct GpioEvent {
  std::uint32_t number = 0;  ///< the kernel's own number of the line: GpioTrace::numberOf()
  bool written = false;      ///< an output was set; otherwise a line was read
  bool level = false;        ///< at the wire, whatever the line's polarity
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC
};

/// Records every access to every GPIO line with the kernel's own time, in a tracing instance of
/// its own: several recorders do not take each other's events.
///
/// Errors   Everything throws std::runtime_error with what the kernel refused.
class GpioTrace {
 public:
  /// Records from here on. @p name is of this recorder alone.
  explicit GpioTrace(std::string name);
  ~GpioTrace();
  GpioTrace(const GpioTrace&) = delete;
  GpioTrace& operator=(const GpioTrace&) = delete;

  /// What was recorded since the last call, in the order of time. Never waits.
  [[nodiscard]] std::vector<GpioEvent> take();

  /// The number under which the line with this name is recorded. Needs one line of the same chip
  /// that no program has requested: it is read once, and its own event gives the number.
  [[nodiscard]] static std::uint32_t numberOf(const std::string& line);

 private:
  std::string folder_;
  std::uint16_t event_id_ = 0;
  std::vector<int> pages_;  // per CPU
};

/// The changes of one output's level, each the write that made it. The first write is one unless
/// the level before is known and the same.
[[nodiscard]] std::vector<GpioEvent> outputEdges(std::span<const GpioEvent> events,
                                                 std::uint32_t number,
                                                 std::optional<bool> before = std::nullopt);

}  // namespace test
