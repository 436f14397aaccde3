#pragma once

#include <atomic>
#include <cstdint>

#include "appliance/capture/association.h"
#include "appliance/capture/capture_board.h"
#include "appliance/capture/frame_history.h"
#include "appliance/capture/trigger_matcher.h"
#include "appliance/trace/trace_writer.h"
#include "hal/camera.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// What one camera delivered so far. Every frame that came is in exactly one of stored, no_slot,
/// incomplete, wrong_size, no_edge, repeated and unsettled.
struct CollectorCounts {
  std::uint64_t stored = 0;
  std::uint64_t missing = 0;       ///< triggers without a frame while the camera counted as present
  std::uint64_t away = 0;          ///< triggers without a frame while it counted as lost
  std::uint64_t no_slot = 0;       ///< good, but readers pinned every free slot
  std::uint64_t incomplete = 0;    ///< packets missing after all resends
  std::uint64_t wrong_size = 0;    ///< another size or format than the profile says
  std::uint64_t no_edge = 0;       ///< taken at no trigger's time
  std::uint64_t repeated = 0;      ///< its trigger has a frame, or a later one has
  std::uint64_t unsettled = 0;     ///< its trigger is not certain; see TriggerMatcher
  std::uint64_t unattributed = 0;  ///< the sum of the last three
  rt::Timestamp last_stored;

  /// Came, but not whole or not of the profile's size.
  [[nodiscard]] std::uint64_t damaged() const { return incomplete + wrong_size; }
  /// Of several cameras: the newest counts as last_stored.
  CollectorCounts& operator+=(const CollectorCounts& other);
};

/// Takes one camera's frames: names the trigger of each, stores it in the history, counts what
/// cannot be stored.
///
/// Threads  onFrame(): the camera's receive thread. counts(): any thread.
/// RT       onFrame() is wait-free but for one futex wake, when its camera is the shown one.
class Collector final : public hal::FrameSink {
 public:
  Collector(std::uint32_t camera, Association association, CameraFrames& frames,
            CaptureBoard& board, TraceProducer* trace)
      : camera_(camera), matcher_(association), frames_(frames), board_(board), trace_(trace) {}

  [[nodiscard]] std::uint32_t onFrame(const hal::FrameArrival& arrival) RT_SAFE override;

  /// A new stream begins: its camera may have been switched off, its clock set back.
  /// Threads  The one that starts the camera, while it is stopped.
  void restart() {
    matcher_.restart();
    restarted_ = true;
  }

  [[nodiscard]] CollectorCounts counts() const RT_SAFE;

 private:
  [[nodiscard]] std::uint64_t triggerOf(const hal::FrameArrival& arrival) RT_SAFE;
  [[nodiscard]] std::uint32_t store(std::uint64_t trigger,
                                    const hal::FrameArrival& arrival) RT_SAFE;

  const std::uint32_t camera_;
  TriggerMatcher matcher_;  // the receive thread's
  bool restarted_ = false;  // likewise; since the last stored frame
  CameraFrames& frames_;
  CaptureBoard& board_;
  TraceProducer* trace_;  // none: not traced

  // Written by the receive thread alone.
  std::atomic<std::uint64_t> stored_{0};
  std::atomic<std::uint64_t> missing_{0};
  std::atomic<std::uint64_t> away_{0};
  std::atomic<std::uint64_t> no_slot_{0};
  std::atomic<std::uint64_t> incomplete_{0};
  std::atomic<std::uint64_t> wrong_size_{0};
  std::atomic<std::uint64_t> no_edge_{0};
  std::atomic<std::uint64_t> repeated_{0};
  std::atomic<std::uint64_t> unsettled_{0};
  std::atomic<std::int64_t> last_stored_ns_{0};
};

}  // namespace appliance
