#pragma once

#include <cstdint>
#include <string>

#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/registers.h"
#include "rt/clock.h"

namespace emulator {

/// Frames a camera keeps to send packets again: as many as a real one's small buffer.
inline constexpr std::uint32_t kFrameHistory = 4;

/// What the cameras see.
///
/// Threads  One thread calls expose().
/// Memory   Everything is made when the scene is; expose() allocates nothing.
class Scene {
 public:
  virtual ~Scene() = default;

  [[nodiscard]] virtual std::uint32_t cameraCount() const = 0;
  [[nodiscard]] virtual SizePx sensorSize(std::uint32_t camera) const = 0;
  [[nodiscard]] virtual std::string cameraName(std::uint32_t camera) const = 0;

  /// The whole sensor of @p camera at one exposure: BayerRG8, linear light, rows without
  /// padding. @p slot in [0, kFrameHistory): the pixels live until the same camera's slot is
  /// exposed again.
  [[nodiscard]] virtual gvsp::Picture expose(std::uint32_t camera, std::uint64_t trigger,
                                             std::uint32_t slot) = 0;

  /// A client started a camera's acquisition. The same thread.
  virtual void onAcquisition() {}
  /// A rising edge came, for all cameras; their exposures follow. The same thread.
  virtual void onTrigger(std::uint64_t /*trigger*/, rt::Timestamp /*edge*/) {}
};

}  // namespace emulator
