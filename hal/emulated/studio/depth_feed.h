#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "hal/emulated/openni/ring.h"
#include "hal/emulated/studio/studio_scene.h"

namespace emulator::studio {

/// Shows the emulated depth sensor the play as it runs, beside the cameras.
///
/// With a folder for the truth: depth_sensor.json says where the sensor stands and what its lens
/// is; depth.csv has, for each picture, when its light was taken and which second of the play it
/// shows.
///
/// Threads  One of its own, of ordinary priority: it copies a picture thirty times a second.
/// Errors   begin(): another emulator feeds the sensor, or something cannot be written.
class DepthFeed {
 public:
  /// @p scene outlives this; @p truth may be empty.
  [[nodiscard]] static std::expected<std::unique_ptr<DepthFeed>, std::string> begin(
      const StudioScene& scene, const std::filesystem::path& truth);

 private:
  DepthFeed(const StudioScene& scene, DepthRingWriter ring, std::ofstream truth);
  void run(const std::stop_token& stop);

  const StudioScene& scene_;
  DepthRingWriter ring_;
  std::ofstream truth_;
  std::jthread thread_;  // ends before what it uses
};

}  // namespace emulator::studio
