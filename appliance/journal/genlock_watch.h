#pragma once

#include <optional>
#include <string>

#include "appliance/status/status.h"

namespace appliance {

/// Notices that the triggers lock to the screen, lose it or cannot, a line each. The way to the
/// first lock is not told.
///
/// Threads  main.
class GenlockWatch {
 public:
  [[nodiscard]] std::optional<std::string> look(const Status& status);

 private:
  GenlockState state_ = GenlockState::kOff;
  GenlockReason reason_ = GenlockReason::kNone;
  std::uint64_t unlocks_ = 0;
};

}  // namespace appliance
