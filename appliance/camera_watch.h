#pragma once

#include <string>
#include <vector>

#include "appliance/control/status.h"

namespace appliance {

/// Notices cameras that fall silent or come back, and frames that were lost, a line each.
///
/// Threads  main.
class CameraWatch {
 public:
  /// What changed since the last look: "camera 7 (cam07): no frames: check its cable and port".
  [[nodiscard]] std::vector<std::string> look(const Status& status);

 private:
  std::vector<CameraStatus> before_;
};

}  // namespace appliance
