#include "hal/emulated/rig/fault_state.h"

#include <cmath>
#include <utility>

namespace emulator {
namespace {

rt::Nanoseconds inNanoseconds(double value, double ns_per_unit) {
  return rt::Nanoseconds{std::llround(value * ns_per_unit)};
}

}  // namespace

void FaultState::apply(const FaultCommand& command, rt::Timestamp now) {
  switch (command.fault) {
    case Fault::kIgnoreTriggers:
      ignore_next_ = static_cast<std::uint32_t>(command.argument);
      break;
    case Fault::kIgnoreEvery:
      ignore_every_ = static_cast<std::uint32_t>(command.argument);
      edges_since_ignored_ = 0;
      break;
    case Fault::kExtraFrame:
      ++extra_frames_;
      break;
    case Fault::kLateLeader:
      hold_ = inNanoseconds(command.argument, 1e6);
      break;
    case Fault::kKill:
      killed_ = true;
      break;
    case Fault::kRevive:
      killed_ = false;
      break;
    case Fault::kReboot: {
      // A camera that starts up is well again; its cable and its clock's crystal are not its own.
      const FaultState before = std::exchange(*this, {});
      killed_ = before.killed_;
      link_mbps_ = before.link_mbps_;
      dark_until_ = now + inNanoseconds(command.argument, 1e9);
      break;
    }
    case Fault::kFreeze:
      frozen_ = true;
      break;
    case Fault::kThaw:
      frozen_ = false;
      break;
    case Fault::kWrongSize:
      wrong_size_ = command.argument != 0;
      break;
    case Fault::kLink:
      link_mbps_ = command.argument;
      break;
    case Fault::kClear: {
      const FaultState before = std::exchange(*this, {});
      dark_until_ = before.dark_until_;
      break;
    }
    case Fault::kDrift:
    case Fault::kLoss:
    case Fault::kReorder:
    case Fault::kDuplicate:
    case Fault::kFrameId:
    case Fault::kMtu:
      break;
  }
}

std::optional<Fault> FaultState::swallowEdge() {
  if (frozen_) return Fault::kFreeze;
  if (ignore_next_ > 0) {
    --ignore_next_;
    return Fault::kIgnoreTriggers;
  }
  if (ignore_every_ > 0 && ++edges_since_ignored_ >= ignore_every_) {
    edges_since_ignored_ = 0;
    return Fault::kIgnoreEvery;
  }
  return std::nullopt;
}

rt::Nanoseconds FaultState::takeHold() {
  return std::exchange(hold_, rt::Nanoseconds{0});
}

}  // namespace emulator
