#include "appliance/journal/genlock_watch.h"

#include <utility>

namespace appliance {

std::optional<std::string> GenlockWatch::look(const Status& status) {
  const GenlockStatus& now = status.genlock;
  const GenlockState state = std::exchange(state_, now.state);
  const GenlockReason reason = std::exchange(reason_, now.reason);
  const bool lost = now.unlocks > std::exchange(unlocks_, now.unlocks);
  const bool changed = state != now.state || reason != now.reason;
  const bool telling = now.state == GenlockState::kLocked || now.reason == GenlockReason::kRatio;
  if (!lost && !(changed && telling)) return std::nullopt;
  return "genlock " + status.genlock_text;
}

}  // namespace appliance
