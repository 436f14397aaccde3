#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "appliance/status/status.h"

namespace appliance {

/// Notices what becomes less than configured while the box runs: a panel that is unplugged, say.
///
/// Threads  main.
class DegradedWatch {
 public:
  /// @p told: the remarks of the start.
  explicit DegradedWatch(const std::vector<Remark>& told) {
    for (const Remark& remark : told) told_.push_back(remark.text);
  }

  /// The lines that were not there at any look before: each is told once in a run, however often
  /// what it tells of comes and goes.
  [[nodiscard]] std::vector<std::string> look(const Status& status) {
    std::vector<std::string> lines;
    for (const Remark& remark : status.degraded) {
      if (std::ranges::find(told_, remark.text) != told_.end()) continue;
      lines.push_back(remark.text);
      told_.push_back(remark.text);
    }
    return lines;
  }

 private:
  std::vector<std::string> told_;
};

}  // namespace appliance
