#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/emulated/rig/rig_file.h"
#include "hal/emulated/rig/scene.h"

namespace emulator {

/// A recording played back, one picture of each camera per trigger, over and over.
///
/// Memory   The whole recording, 1 byte per pixel and picture, decoded when opened; refused
///          when that is more than half of the memory that is free.
class RecordingScene final : public Scene {
 public:
  /// @p folder holds rig.toml and, per camera of it, a video (NAME.mp4, .mkv, .avi, .mov) or a
  /// folder NAME/ of pictures (.png, .jpg), taken in the order of their names. Cameras with
  /// more pictures than another lose their last ones. Says on stderr how far it is.
  [[nodiscard]] static std::expected<RecordingScene, std::string> open(
      const std::filesystem::path& folder);

  [[nodiscard]] std::uint32_t cameraCount() const override;
  [[nodiscard]] SizePx sensorSize(std::uint32_t camera) const override;
  [[nodiscard]] std::string cameraName(std::uint32_t camera) const override;
  [[nodiscard]] std::size_t pictureCount() const { return picture_count_; }
  /// Trigger 1 shows the first picture.
  [[nodiscard]] gvsp::Picture expose(std::uint32_t camera, std::uint64_t trigger,
                                     std::uint32_t slot) override;

 private:
  RecordingScene(RigModel rig, std::vector<std::vector<std::uint8_t>> pictures,
                 std::size_t picture_count);

  RigModel rig_;
  std::vector<std::vector<std::uint8_t>> pictures_;  // per camera, one after the other
  std::size_t picture_count_;
};

}  // namespace emulator
