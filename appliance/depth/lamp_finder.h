#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "appliance/depth/latency.h"
#include "hal/depth_sensor.h"

namespace appliance {

/// Looks in colour pictures for the spot whose brightness changes most: a lamp that goes on and
/// off before a still room.
///
/// Threads  One caller.
class LampFinder {
 public:
  static constexpr std::uint32_t kColumns = 40;
  static constexpr std::uint32_t kRows = 30;

  /// @p frame has colour and at least kColumns x kRows pixels.
  void add(const hal::DepthFrame& frame);

  /// The brightness of that spot in every picture so far.
  [[nodiscard]] std::vector<LampSample> samples() const;

 private:
  using Cells = std::array<float, std::size_t{kColumns} * kRows>;

  struct Picture {
    rt::Timestamp at;
    Cells cells;
  };
  std::vector<Picture> pictures_;
};

}  // namespace appliance
