#pragma once

#include <optional>
#include <string>

#include "appliance/status/status.h"

namespace appliance {

/// What happens to the screen, a line at each change.
///
/// Threads  main.
class ScreenWatch {
 public:
  [[nodiscard]] std::optional<std::string> look(const Status& status) {
    std::string line = "screen: " + std::string(nameOf(status.screen));
    if (!status.screen_message.empty()) line += ": " + status.screen_message;
    if (line == last_) return std::nullopt;
    last_ = line;
    return line;
  }

 private:
  std::string last_ = "screen: showing";
};

}  // namespace appliance
