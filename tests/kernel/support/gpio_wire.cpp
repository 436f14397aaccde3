#include "tests/kernel/support/gpio_wire.h"

#include <chrono>
#include <utility>

#include "tests/kernel/support/files.h"

namespace test {
namespace {

// The kernel wakes a reader of the trace with its next tick, 10 ms; looking is sooner.
constexpr std::chrono::microseconds kLookEvery{500};

}  // namespace

GpioWire::GpioWire(const std::string& line, Receiver to)
    : number_(GpioTrace::numberOf(line)),
      trace_("wire-" + line),
      to_(std::move(to)),
      thread_([this](const std::stop_token& stop) { carry(stop); }) {}

void GpioWire::carry(const std::stop_token& stop) {
  std::optional<bool> level;
  while (!stop.stop_requested()) {
    for (const GpioEvent& edge : outputEdges(trace_.take(), number_, level)) {
      level = edge.level;
      to_(edge);
    }
    std::this_thread::sleep_for(kLookEvery);
  }
}

GpioWire::Receiver pullOf(std::string input_folder, bool inverted) {
  return [pull = std::move(input_folder) + "/pull", inverted](const GpioEvent& edge) {
    writeAttribute(pull, edge.level != inverted ? "pull-up" : "pull-down");
  };
}

}  // namespace test
