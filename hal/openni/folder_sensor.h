#pragma once

#include <expected>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "hal/depth_sensor.h"
#include "hal/openni/folder_recording.h"
#include "hal/openni/play_clock.h"

namespace hal::openni {

struct FolderSettings {
  std::filesystem::path folder;
  Play play = Play::kRealTime;
  bool repeat = true;
};

/// A folder of pictures, played as a sensor. A picture that cannot be read is counted as lost.
///
/// Threads  waitFrame(): one caller. status(): any.
class FolderSensor final : public DepthSensor {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<FolderSensor>, std::string> open(
      const FolderSettings& settings);

  [[nodiscard]] std::optional<DepthFrame> waitFrame(rt::Nanoseconds timeout) override;
  [[nodiscard]] DepthStatus status() const override;

 private:
  FolderSensor(FolderSettings settings, FolderRecording recording);

  /// The next picture that can be read, decoded ahead of the instant it is due. False: the end.
  [[nodiscard]] bool readNext();

  const FolderSettings settings_;
  const FolderRecording recording_;
  std::size_t next_ = 0;
  PlayClock clock_;
  std::optional<std::uint64_t> last_number_;
  struct Ready {
    const FolderRecording::Entry* entry;
    FolderRecording::Pictures pictures;
    rt::Timestamp exposure;
  };
  std::optional<Ready> ready_;
  Ready lent_{};

  mutable std::mutex mutex_;  // guards status_
  DepthStatus status_;
};

}  // namespace hal::openni
