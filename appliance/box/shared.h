#pragma once

#include <string>
#include <utility>

#include "appliance/box/remarks.h"
#include "appliance/box/threads.h"
#include "appliance/capture/capture_board.h"
#include "appliance/capture/frame_history.h"
#include "appliance/config/config.h"
#include "appliance/depth/depth_board.h"
#include "appliance/director/command_inbox.h"
#include "appliance/director/shown_board.h"
#include "appliance/geometry/rig.h"
#include "appliance/geometry/rig_shelf.h"
#include "appliance/geometry/target_track.h"
#include "appliance/jobs/job_registry.h"
#include "appliance/metrics/metrics_registry.h"
#include "appliance/overlay/overlay_board.h"
#include "appliance/render/picture_observer.h"
#include "appliance/trace/trace_writer.h"
#include "hal/display.h"

namespace appliance {

/// What parts share, made before the first of them and gone after the last. Parts meet here and
/// nowhere else: each board says in its own contract who writes and who reads.
struct Shared {
  MetricsRegistry& metrics;
  JobRegistry& jobs;
  const Config& config;
  const Rig& rig;  ///< the first one: count, names and sizes of the cameras hold for the run
  RigShelf& rigs;
  FrameHistory& history;
  CaptureBoard& board;
  TargetTrack& target;
  DepthBoard& depth;
  OverlayBoard& overlay;
  CommandInbox& commands;
  ShownBoard& shown;
  hal::Display& display;
  PictureObserver* observer;  ///< none: no observer
  TraceWriter* trace;         ///< none: not traced
  Threads& threads;
  Remarks& remarks;

  /// The end of the trace for one more thread. None: not traced.
  [[nodiscard]] TraceProducer* traceProducer(std::string name) const {
    return trace != nullptr ? &trace->addProducer(std::move(name)) : nullptr;
  }
};

}  // namespace appliance
