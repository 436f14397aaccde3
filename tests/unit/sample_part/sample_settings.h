#pragma once

#include <chrono>

namespace appliance {

class Section;

/// Section `[sample]`.
struct SampleSettings {
  bool enabled = true;
  std::chrono::milliseconds period{1};
  bool operator==(const SampleSettings&) const = default;
};

void read(Section section, SampleSettings& sample);

}  // namespace appliance
