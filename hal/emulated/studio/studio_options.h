#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/emulated/rig/registers.h"

namespace emulator::studio {

struct StudioOptions {
  std::uint32_t cameras = 20;
  SizePx size{1280, 1024};
  std::uint64_t seed = 1;
  double play_s = 24;         ///< length of the scene, which then begins again
  double first_play_s = 3;    ///< enough to begin with
  double patience_s = 50;     ///< with less than that, if drawing it takes so long
  bool depth_sensor = false;  ///< draw what it sees, too
  bool grow = true;           ///< go on drawing while no camera sends
  /// Draw these moments alone, in this order, and keep none of them: for stills. Empty: the play.
  std::vector<std::uint32_t> only;
  std::filesystem::path cache;  ///< folder of all scenes; empty: none
  double cache_gib = 6;         ///< of all scenes together
};

}  // namespace emulator::studio
