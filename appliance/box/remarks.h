#pragma once

#include <string>
#include <utility>
#include <vector>

#include "appliance/status/status_section.h"

namespace appliance {

/// What became less than configured while the box was set up, and stays so for the run.
///
/// Threads  main.
class Remarks {
 public:
  void add(std::string key, const Phrase& phrase) {
    remarks_.push_back(remarkOf(std::move(key), phrase));
  }
  [[nodiscard]] const std::vector<Remark>& list() const { return remarks_; }

 private:
  std::vector<Remark> remarks_;
};

}  // namespace appliance
