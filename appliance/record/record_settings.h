#pragma once

#include <cstdint>
#include <string>

namespace appliance {

class Section;

/// What is kept of the pictures that were shown.
struct RecordSettings {
  std::string directory;  ///< empty: nothing is recorded
  double video_hz = 20;
  std::uint32_t video_width_px = 640;
  bool operator==(const RecordSettings&) const = default;
};

/// Reads `[record]`.
void read(Section section, RecordSettings& record);

}  // namespace appliance
