#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace hal {

enum class FrameStatus : std::uint8_t {
  kComplete,    ///< every packet arrived; only these are ever shown
  kIncomplete,  ///< packets missing after all resends
  kWrongSize,   ///< the camera sent another size or format than the profile says
  kAborted,     ///< the stream ended while the frame was filling
};

/// One frame that a camera delivered into a slot of the caller's memory.
struct FrameArrival {
  std::uint32_t slot = 0;  ///< index into the slots given to Camera::start()
  FrameStatus status = FrameStatus::kAborted;
  std::uint64_t frame_id = 0;  ///< counted by the camera, unwrapped; finds frames lost on the wire
  rt::Nanoseconds camera_clock{0};  ///< the camera's own stamp of the frame; 0: it gave none
  rt::Timestamp first_packet;       ///< this machine looked at the leader
  rt::Timestamp last_packet;        ///< the frame's last packet was taken from the socket
};

/// Who takes the frames of one camera.
///
/// Threads  onFrame() runs on that camera's own receive thread, one call at a time.
/// RT       onFrame() must be RT safe: the receive thread cannot wait.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// Takes ownership of arrival.slot and returns the slot to fill next (it may be the same one).
  [[nodiscard]] virtual std::uint32_t onFrame(const FrameArrival& arrival) RT_SAFE = 0;
};

/// What the wire did, counted since start().
struct CameraStatistics {
  std::uint64_t frames_complete = 0;
  std::uint64_t frames_incomplete = 0;
  std::uint64_t packets_resent = 0;
  std::uint64_t packets_missing = 0;
  std::uint64_t underruns = 0;  ///< packets that found no free slot
};

/// One camera of the rig, opened by address, configured and stopped.
///
/// Threads  start(), stop(), statistics(): the owner. Frames arrive on a thread of the backend.
/// Memory   Frames are written straight into the slots; the slots outlive the camera's last stop().
/// Errors   Strings for a person: which camera, what, what to do.
class Camera {
 public:
  virtual ~Camera() = default;

  /// Streams into @p slots: the backend fills @p first_slots in that order, then
  /// whatever onFrame() returns. The sink outlives stop().
  virtual std::expected<void, std::string> start(FrameSink& sink,
                                                 std::span<const std::span<std::byte>> slots,
                                                 std::span<const std::uint32_t> first_slots) = 0;

  /// Returns when no further onFrame() can come. Idempotent.
  virtual void stop() = 0;

  [[nodiscard]] virtual CameraStatistics statistics() const = 0;

  /// What opening found that is not as the profile asks, although the camera works: one line each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
};

}  // namespace hal
