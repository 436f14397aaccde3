#include <bit>
#include <cmath>

#include "appliance/control/control_requests.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using appliance::Requested;

void check(const Requested& requested, const appliance::Status& now) {
  if (!requested) {
    fuzz::requireOneLine(textOf(requested.error()));
    return;
  }
  using enum appliance::Command::Kind;
  if (requested->kind == kSetView)
    fuzz::require(requested->camera < now.cameras.size(), "a view that is asked for exists");
  if (requested->kind == kCompare && requested->camera != appliance::Command::kSameView)
    fuzz::require(requested->camera < now.cameras.size(), "a view to compare with exists");
  if (requested->kind == kSetDelay || requested->kind == kReplay || requested->kind == kCompare)
    fuzz::require(requested->delay <= std::chrono::milliseconds(now.history_ms),
                  "a delay lies within the history");
}

}  // namespace

/// The box's state, then the arguments of every request; the rest is the name of a mode
/// and a speed.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  appliance::Status now;
  now.mode = static_cast<appliance::Mode>(bytes.number<std::uint8_t>() % appliance::kModes.size());
  now.cameras.resize(bytes.number<std::uint8_t>());
  now.history_ms = bytes.number<std::uint32_t>();
  check(appliance::requestDelay(bytes.number<std::uint32_t>(), now), now);
  check(appliance::requestView(bytes.number<std::uint32_t>(), now), now);
  std::array<double, 3> target_m{};
  for (double& coordinate : target_m)
    coordinate = std::bit_cast<double>(bytes.number<std::uint64_t>());
  const auto target = appliance::requestTarget(target_m[0], target_m[1], target_m[2]);
  if (!target) fuzz::requireOneLine(textOf(target.error()));
  for (const double coordinate : target.value_or(std::array<double, 3>{}))
    fuzz::require(std::isfinite(coordinate), "a target is finite");
  const auto mode = bytes.take(size);
  const auto name = fuzz::text(mode.data(), mode.size());
  check(appliance::requestMode(name), now);
  check(appliance::requestSpeed(name), now);
  check(appliance::requestCompare(name, static_cast<std::uint32_t>(size), now.history_ms / 2, 0.5,
                                  now),
        now);
  check(appliance::requestReplay(now.history_ms / 2, name, now), now);
  return 0;
}
