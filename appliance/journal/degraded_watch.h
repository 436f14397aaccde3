#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "appliance/control/status.h"

namespace appliance {

/// Notices what becomes less than configured while the box runs: a panel that is unplugged, say.
///
/// Threads  main.
class DegradedWatch {
 public:
  /// @p told: the lines of the start.
  explicit DegradedWatch(std::vector<std::string> told) : told_(std::move(told)) {}

  /// The lines that were not there at any look before: each is told once in a run, however often
  /// what it tells of comes and goes.
  [[nodiscard]] std::vector<std::string> look(const Status& status) {
    std::vector<std::string> lines;
    for (const std::string& line : status.degraded) {
      if (std::ranges::find(told_, line) != told_.end()) continue;
      lines.push_back(line);
      told_.push_back(line);
    }
    return lines;
  }

 private:
  std::vector<std::string> told_;
};

}  // namespace appliance
