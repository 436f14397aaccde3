#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "appliance/capture/genlock_status.h"
#include "appliance/director/shot.h"
#include "hal/camera.h"
#include "rt/clock.h"

/// What a run leaves behind: the instants of every trigger, frame and picture, one record each.
/// docs/trace.md describes the file; the field names there are these names plus `_ns` for instants.
/// An instant of zero did not happen. Cameras count from 0, triggers and pictures from 1.
namespace appliance {

/// One pulse of the trigger line, by the trigger loop.
struct TriggerRecord {
  std::uint64_t trigger = 0;
  rt::Timestamp deadline;             ///< when the pulse should have left
  rt::Timestamp trigger_edge_before;  ///< it left between these two
  rt::Timestamp trigger_edge_after;
};

/// An edge of the trigger line as the loop-back input saw it, by the loop-back thread.
struct LoopbackRecord {
  std::uint64_t trigger = 0;  ///< 0: no trigger edge was near enough
  rt::Timestamp edge;         ///< as the kernel stamped it
};

/// One frame that a camera delivered, whole or not, by that camera's receive thread.
struct FrameRecord {
  std::uint32_t camera = 0;
  hal::FrameStatus status = hal::FrameStatus::kAborted;
  std::uint64_t trigger = 0;   ///< 0: no trigger edge was near enough
  std::uint64_t frame_id = 0;  ///< the camera's own count, unwrapped
  rt::Timestamp first_packet;
  rt::Timestamp last_packet;
  rt::Timestamp frame_ready;  ///< the frame stands in the history, readable
};

/// The last frame of a trigger arrived. The thread that completed the set writes it.
struct SetRecord {
  std::uint64_t trigger = 0;
  rt::Timestamp set_complete;
};

/// One picture that was handed to the display, by the render thread.
struct PictureRecord {
  std::uint64_t picture_id = 0;
  Mode mode = Mode::kLive;
  bool substitute = false;  ///< a neighbour of camera_wanted is shown instead
  bool imported = false;    ///< the frame was read in its slot, not uploaded
  std::uint32_t camera_wanted = 0;
  std::uint32_t camera_shown = 0;
  std::uint64_t trigger = 0;  ///< 0: an empty picture
  ShownFrame second;          ///< of a comparison
  rt::Timestamp wake;         ///< the render thread began this picture
  rt::Timestamp target_point_begin;
  rt::Timestamp target_point_end;
  rt::Timestamp homographies_begin;  ///< the homographies of all cameras
  rt::Timestamp homographies_end;
  rt::Timestamp warp_submit;
  rt::Timestamp upload_end;
  rt::Timestamp warp_end;
  rt::Timestamp commit;
  rt::Timestamp button_event;  ///< the press whose effect this picture is the first to show
};

/// A committed picture came on screen, by the render thread.
struct FlipRecord {
  std::uint64_t picture_id = 0;
  rt::Timestamp page_flip;
  std::uint64_t vblank = 0;
};

/// What the genlock did: at every change of its state and now and then, by the trigger loop.
struct GenlockRecord {
  std::uint64_t trigger = 0;  ///< the first one that was fired in this state
  GenlockState state = GenlockState::kOff;
  GenlockReason reason = GenlockReason::kNone;
  bool hold_over = false;
  std::uint32_t vblanks_per_trigger = 0;
  rt::Nanoseconds phase_error{};    ///< of that trigger, before it was corrected
  rt::Nanoseconds lead{};           ///< from trigger to the vblank it is meant for
  rt::Nanoseconds vblank_period{};  ///< 0: not known
  std::uint64_t unlocks = 0;        ///< so far
};

/// The machine itself stood still, as the probe of one CPU saw it; by main.
struct StallRecord {
  std::uint32_t cpu = 0;
  rt::Timestamp begin;
  rt::Timestamp end;
};

/// What crosses from a real-time thread to the trace writer.
using TraceRecord = std::variant<TriggerRecord, FrameRecord, SetRecord, PictureRecord, FlipRecord,
                                 LoopbackRecord, GenlockRecord, StallRecord>;
static_assert(std::is_trivially_copyable_v<TraceRecord>, "records cross threads by copy");

/// What a named thread asked for and what the kernel granted.
struct TracedThread {
  std::string name;
  std::string policy;  ///< "fifo", "rr" or "other": what it really runs with
  int priority = 0;
  int cpu = -1;  ///< -1: any
  bool as_asked = true;
};

/// The first line: what ran, known before the first trigger.
struct RunRecord {
  std::string version;  ///< which sources ran; empty in a trace of before there was this field
  std::uint32_t cameras = 0;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::string pixel_format;
  double trigger_hz = 0;
  std::uint32_t display_width_px = 0;
  std::uint32_t display_height_px = 0;
  double refresh_hz = 0;
  std::string renderer;
  std::string source_path;  ///< how frames reach the renderer: "dma-buf" or "upload: <why>"
  std::uint32_t history_sets = 0;
  std::uint64_t memory_bytes = 0;  ///< the frame history, in-flight and reserve slots included
  bool memory_locked = false;
  std::vector<TracedThread> threads;
  std::vector<std::string> degraded;  ///< one line per thing that is less than configured
  rt::Timestamp start;
};

/// The last line: how it ended. A trace without one was cut off.
struct SummaryRecord {
  bool clean_stop = false;
  rt::Timestamp stop;
  double cpu_seconds = 0;          ///< user and system time of the daemon
  std::uint64_t memory_bytes = 0;  ///< resident at the end
  std::uint64_t frames_lost = 0;   ///< as the running daemon counted them
  std::uint64_t frames_away = 0;   ///< not taken because their camera was lost
  std::uint64_t frames_incomplete = 0;
  std::uint64_t frames_unattributed = 0;
  std::uint64_t pictures_skipped = 0;  ///< vblanks for which the render thread came too late
  std::uint64_t trace_dropped = 0;     ///< records the trace itself lost; TraceWriter fills it in
};

}  // namespace appliance
