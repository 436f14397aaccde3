#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "hal/emulated/rig/rig_file.h"
#include "hal/emulated/rig/scene.h"
#include "hal/emulated/rig/stamp_card.h"
#include "rt/memory.h"

namespace emulator {

/// A training hall with a mannequin, seen by a rig of arc cameras; every frame carries a card
/// with its camera and trigger. The hall is drawn once; a frame costs only its card.
/// Memory   Per camera one picture, and kFrameHistory times the band of rows with the card, in
///          huge pages where the system has them: every byte is read again for each frame, and
///          on small pages a third of the sending time went into finding them.
class StampScene final : public Scene {
 public:
  /// Refuses sizes that cannot hold the card.
  [[nodiscard]] static std::expected<StampScene, std::string> make(std::uint32_t cameras,
                                                                   SizePx size);

  [[nodiscard]] const RigModel& rig() const { return rig_; }
  [[nodiscard]] std::uint32_t cameraCount() const override;
  [[nodiscard]] SizePx sensorSize(std::uint32_t camera) const override;
  [[nodiscard]] std::string cameraName(std::uint32_t camera) const override;
  [[nodiscard]] gvsp::Picture expose(std::uint32_t camera, std::uint64_t trigger,
                                     std::uint32_t slot) override;

 private:
  struct View {  // in pictures_
    std::span<std::uint8_t> hall;
    std::array<std::span<std::uint8_t>, kFrameHistory> bands;
  };

  StampScene(RigModel rig, SizePx size, rt::LockedArena pictures);
  /// The rows that the card lies in.
  [[nodiscard]] static std::size_t bandBytes(SizePx size);
  [[nodiscard]] static std::size_t viewBytes(SizePx size);
  void draw(std::size_t camera);

  RigModel rig_;
  SizePx size_;
  StampLayout layout_;
  StampCard card_;
  rt::LockedArena pictures_;
  std::vector<View> views_;
};

}  // namespace emulator
