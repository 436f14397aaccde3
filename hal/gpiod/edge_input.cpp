#include "hal/gpiod/edge_input.h"

#include <system_error>
#include <utility>
#include <vector>

#include <gpiod.hpp>

#include "hal/gpiod/edge_waiter.h"
#include "hal/gpiod/line_finder.h"
#include "hal/gpiod/requests.h"

namespace hal::gpiod {
namespace {

constexpr const char* kKey = "trigger.loopback_line";

class GpioEdgeInput final : public EdgeInput {
 public:
  GpioEdgeInput(std::vector<::gpiod::line_request> request, unsigned offset)
      : edges_(std::move(request)), offset_(offset) {}

  std::optional<InputEdge> waitEdge(rt::Nanoseconds timeout) override {
    const auto edge = edges_.wait(timeout);
    if (!edge) return std::nullopt;
    return InputEdge{.active = edge->active, .at = edge->at};
  }

  rt::Result<bool> isActive() override {
    try {
      return edges_.request(0).get_value(offset_) == ::gpiod::line::value::ACTIVE;
    } catch (const std::system_error& error) {
      return std::unexpected(
          rt::Error{rt::Errc::kDeviceLost, error.code().value(), "read a GPIO input"});
    }
  }

 private:
  EdgeWaiter edges_;
  unsigned offset_;
};

}  // namespace

std::expected<std::unique_ptr<EdgeInput>, std::string> openEdgeInput(
    const EdgeInputSettings& settings) {
  const auto line = findLine(listLines(), settings.line, kKey);
  if (!line) return std::unexpected(line.error());
  ::gpiod::line_settings input;
  input.set_direction(::gpiod::line::direction::INPUT)
      .set_edge_detection(::gpiod::line::edge::BOTH)
      .set_event_clock(::gpiod::line::clock::MONOTONIC)
      .set_active_low(settings.active_low);
  auto request = requestLines({*line}, input, kKey);
  if (!request) return std::unexpected(request.error());
  std::vector<::gpiod::line_request> requests;
  requests.push_back(std::move(*request));
  return std::make_unique<GpioEdgeInput>(std::move(requests), line->offset);
}

}  // namespace hal::gpiod
