#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "appliance/capture/collector.h"
#include "hal/camera_profile.h"
#include "rt/clock.h"
#include "rt/thread.h"

namespace bench {

/// What every contestant is given: the same cameras, settings, memory and scheduling.
struct ReceptionSetup {
  std::vector<hal::CameraProfile> cameras;
  rt::Nanoseconds period{};  ///< between triggers
  std::uint32_t sets = 24;   ///< frames per camera that stay in memory
  rt::ThreadConfig receive;  ///< of each camera's receive thread

  [[nodiscard]] std::size_t frameBytes() const {
    return std::size_t{cameras.front().width_px} * cameras.front().height_px;
  }
  /// Frames per camera that are with the network or beyond `sets`.
  static constexpr std::uint32_t kInFlight = 8;
  static constexpr std::uint32_t kReserve = 4;
  [[nodiscard]] std::uint32_t slots() const { return sets + kInFlight + kReserve; }
};

/// One way to receive all cameras of a rig; it receives from its making to its end.
class Receiver {
 public:
  virtual ~Receiver() = default;
  /// Complete frames since it was made, all cameras together. Any thread.
  [[nodiscard]] virtual std::uint64_t frames() const = 0;
};

using MadeReceiver = std::expected<std::unique_ptr<Receiver>, std::string>;

/// The product's: camera backend, collectors, frame history.
[[nodiscard]] MadeReceiver receiveAsAppliance(const ReceptionSetup& setup,
                                              appliance::CaptureBoard& board);
/// The least that an Aravis client does: takes each frame from its stream and gives the buffer
/// back.
[[nodiscard]] MadeReceiver receiveByAravis(const ReceptionSetup& setup);
/// Without Aravis' stream: recvmmsg(2), and each packet's payload copied to its place. Asks for
/// nothing again.
[[nodiscard]] MadeReceiver receiveByRecvmmsg(const ReceptionSetup& setup);

}  // namespace bench
