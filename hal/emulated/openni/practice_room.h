#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/emulated/openni/ring.h"

namespace emulator {

/// A small room with one person who walks to and fro and waves: something for a depth sensor to
/// see where there is no studio. A pure function of the time.
///
/// The camera stands 1.2 m over the floor and looks level; x right, y down, z forward, metres.
///
/// Threads  One caller.
class PracticeRoom {
 public:
  explicit PracticeRoom(const RgbdFormat& format);

  /// Everything at @p time_s, with the lamp in the corner on or off.
  void draw(double time_s, bool lamp, const DepthRingWriter::Canvas& canvas) const;

  /// The person's chest, metres.
  [[nodiscard]] static std::array<double, 3> chest(double time_s);

 private:
  RgbdFormat format_;
  std::vector<float> depth_m_;  // without the person
  std::vector<std::uint8_t> rgb_;
};

}  // namespace emulator
