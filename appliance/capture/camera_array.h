#pragma once

#include <cstddef>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "appliance/capture/association.h"
#include "appliance/capture/camera_status.h"
#include "appliance/capture/camera_supervisor.h"
#include "appliance/capture/capture_board.h"
#include "appliance/capture/collector.h"
#include "appliance/capture/frame_history.h"
#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "appliance/status/status_section.h"
#include "appliance/trace/trace_writer.h"

namespace appliance {

/// All cameras of the rig: each one's collector, and the supervisor that keeps it streaming.
///
/// Threads  All members: the owner. A thread per camera watches it, and its backend receives on
///          another.
/// Memory   Everything given outlives the array.
class CameraArray {
 public:
  /// @p trace: none, or one that has not begun yet.
  CameraArray(const Config& config, const Rig& rig, FrameHistory& history, CaptureBoard& board,
              TraceWriter* trace);

  /// Starts all together. Returns when each camera streams or its first attempt has failed; a
  /// failed one is named in statuses() and tried again forever. Errors: a thread could not be made;
  /// stop() stops the others.
  [[nodiscard]] std::expected<void, std::string> start();
  void stop();

  [[nodiscard]] std::vector<CameraStatus> statuses() const;
  /// What is wrong at cameras that stream all the same.
  [[nodiscard]] std::vector<Remark> remarks() const;
  /// The sums over all cameras.
  [[nodiscard]] CollectorCounts counts() const;
  [[nodiscard]] std::size_t size() const { return collectors_.size(); }
  /// Of one camera, from 0.
  [[nodiscard]] CollectorCounts counts(std::size_t camera) const {
    return collectors_[camera]->counts();
  }
  [[nodiscard]] const PacketCounts& packets(std::size_t camera) const {
    return supervisors_[camera]->packets();
  }

 private:
  const Rig& rig_;
  std::vector<std::unique_ptr<Collector>> collectors_;
  std::vector<std::unique_ptr<CameraSupervisor>> supervisors_;
};

}  // namespace appliance
