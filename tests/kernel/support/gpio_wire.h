#pragma once

#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "tests/kernel/support/gpio_trace.h"

namespace test {

/// The wire at an output: hands every change of its level to the part at the other end,
/// soon after it happened and with the instant at which it did.
///
/// Threads  One of its own, which calls @p to.
class GpioWire {
 public:
  using Receiver = std::function<void(const GpioEvent& edge)>;

  /// @p line: the output's name. Open it before the output is driven: earlier edges are not seen.
  GpioWire(const std::string& line, Receiver to);
  ~GpioWire() = default;
  GpioWire(const GpioWire&) = delete;
  GpioWire& operator=(const GpioWire&) = delete;

 private:
  void carry(const std::stop_token& stop);

  std::uint32_t number_;
  GpioTrace trace_;
  Receiver to_;
  std::jthread thread_;  // last: it uses the others
};

/// The receiver that pulls an input after the output: a loop-back wire. @p input_folder:
/// GpioSim::lineFolder() of the input. @p inverted: as through an opto-coupler.
[[nodiscard]] GpioWire::Receiver pullOf(std::string input_folder, bool inverted = false);

}  // namespace test
