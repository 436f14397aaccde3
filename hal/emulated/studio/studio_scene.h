#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "hal/emulated/rig/scene.h"
#include "hal/emulated/studio/depth_pace.h"
#include "hal/emulated/studio/play.h"
#include "rt/memory.h"
#include "rt/shared_value.h"

namespace emulator::studio {

/// An athlete at practice in a hall, drawn in advance; trigger 1 shows the first moment. After
/// the last moment that is ready it begins again.
///
/// Memory   Four pictures per camera, beside what Play holds.
class StudioScene final : public Scene {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<StudioScene>, std::string> make(
      const StudioOptions& options, const Play::Progress& progress);

  [[nodiscard]] const Play& play() const { return *play_; }
  [[nodiscard]] RigModel rig() const { return play_->rig().model(); }
  [[nodiscard]] std::uint32_t cameraCount() const override;
  [[nodiscard]] SizePx sensorSize(std::uint32_t camera) const override;
  [[nodiscard]] std::string cameraName(std::uint32_t camera) const override;
  [[nodiscard]] gvsp::Picture expose(std::uint32_t camera, std::uint64_t trigger,
                                     std::uint32_t slot) override;
  void onAcquisition() override;
  void onTrigger(std::uint64_t trigger, rt::Timestamp edge) override;
  /// What the last trigger shows. Any thread.
  [[nodiscard]] PlayingMoment playing() const { return playing_.load(); }

  /// Since when the scene plays once more, and for how many moments.
  struct Round {
    std::uint64_t first_trigger = 1;
    std::uint32_t moments = 0;
  };
  /// From the first on; only so many are remembered.
  [[nodiscard]] const std::vector<Round>& rounds() const { return rounds_; }

 private:
  StudioScene(std::unique_ptr<Play> play, rt::LockedArena memory);
  [[nodiscard]] std::uint32_t momentOf(std::uint64_t trigger);

  std::unique_ptr<Play> play_;
  SizePx size_;
  rt::LockedArena memory_;
  std::vector<std::array<std::span<std::uint8_t>, 4>> backgrounds_;
  std::vector<Round> rounds_;
  Round round_;
  rt::Timestamp last_edge_;
  std::uint64_t last_trigger_ = 0;
  rt::SharedValue<PlayingMoment> playing_;
};

}  // namespace emulator::studio
