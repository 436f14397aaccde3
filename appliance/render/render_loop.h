#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "appliance/capture/capture_board.h"
#include "appliance/director/command_inbox.h"
#include "appliance/director/director.h"
#include "appliance/director/shown_board.h"
#include "appliance/geometry/rig_shelf.h"
#include "appliance/geometry/target_track.h"
#include "appliance/geometry/view_set.h"
#include "appliance/light/flicker.h"
#include "appliance/overlay/overlay_board.h"
#include "appliance/render/locked_vblanks.h"
#include "appliance/render/moment_hold.h"
#include "appliance/render/picture_observer.h"
#include "appliance/render/render_allowance.h"
#include "appliance/render/render_metrics.h"
#include "appliance/render/sighted_views.h"
#include "appliance/render/stored_frames.h"
#include "appliance/trace/trace_writer.h"
#include "hal/display.h"
#include "rt/high_quantile.h"
#include "rt/latest_value.h"

namespace appliance {

/// What the render thread reports.
struct RenderStatus {
  Shot shot;
  hal::ScreenStatus screen;
  std::uint64_t blind = 0;  ///< a bit for each camera that does not have the target in its picture
  std::uint32_t cover_worst = 0;  ///< the camera that needs most zoom to cover the screen
  double cover_needed = 0;        ///< that zoom; 0: the zoom is fixed
  FlickerReport flicker;          ///< of the light; all zeros without compensation
  Target target;                  ///< of the shown moment
  rt::Timestamp exposure_middle;  ///< of the shown moment; the epoch: not known
};

/// Everything the render loop works with; all outlives it.
struct RenderParts {
  RigShelf& rigs;
  StoredFrames& frames;  ///< by a reader that may pin RenderLoop::kPinsPerCamera
  CaptureBoard& board;
  CommandInbox& commands;
  ShownBoard& shown;
  const TargetTrack& target;
  hal::Display& display;
  OverlayBoard& overlay;
  TraceProducer* trace;       ///< none: not traced
  PictureObserver* observer;  ///< none: no observer
};

struct RenderParameters {
  rt::Nanoseconds trigger_period;
  rt::Nanoseconds edge_to_exposure_middle{0};  ///< opto delay, and half of the exposure
  std::optional<double> zoom;                  ///< none: the smallest that leaves no border
  DirectorParameters director;
  bool flicker_compensation = false;
};

/// Shows the picture that the director decides on. Wakes when the shown camera has a new frame or a
/// command was given.
///
/// Threads  run(): the `render` thread. status(): one reader.
/// RT       Waits for the doorbell and draws. GL and the display may block: this loop is
///          not RT safe. Its priority is above that of receiving, and an allowance limits it, so
///          that capture has 40 % of each CPU. While triggers are locked, a picture that would flip
///          a vblank early waits.
class RenderLoop {
 public:
  /// Two for what is shown (a picture may show two moments of one camera), those of both held
  /// moments, and one to spare.
  static constexpr std::uint32_t kPinsPerCamera = 2 + 2 * MomentHold::kPinsPerCamera + 1;

  RenderLoop(const RenderParts& parts, const RenderParameters& parameters);

  void run(const std::stop_token& stop) noexcept;

  /// Releases the screen for another program, or takes it back. The last call wins. Any thread.
  void setScreenReleased(bool released) noexcept {
    screen_released_.store(released, std::memory_order_relaxed);
    parts_.board.wake_render.ring();
  }

  [[nodiscard]] const RenderMetrics& metrics() const { return metrics_; }
  [[nodiscard]] RenderStatus status() { return status_.latest(); }

 private:
  /// One of the shots: its frame's time, and what stands in the middle of it.
  struct Moment {
    rt::Timestamp trigger_edge;
    rt::Timestamp exposure_middle;
    Target target;
  };
  /// The frames of the first and the second shot.
  using Frames = std::array<std::optional<PinnedFrame>, 2>;

  struct Wanted {
    Presentation picture;
    Shot shot;
    Moment first, second;
    std::uint64_t overlay = 0;  // its generation
    std::uint64_t rig = 0;      // its revision
    rt::Timestamp target_point_begin;
    rt::Timestamp target_point_end;
  };

  [[nodiscard]] rt::Timestamp nextWake(rt::Timestamp now) const noexcept;
  void turn() noexcept;
  void takeCommands() noexcept;
  void answerCommands() noexcept;
  void followScreen() noexcept;
  void sayWhatIsShown(const Shot& shot) noexcept;
  [[nodiscard]] bool pin(const Shot& shot, Frames& frames) noexcept;
  [[nodiscard]] Moment momentOf(const std::optional<PinnedFrame>& frame, const Rig& rig) noexcept;
  [[nodiscard]] bool onScreen(const Wanted& wanted, rt::Timestamp now) const noexcept;
  [[nodiscard]] bool show(const Wanted& wanted, const RigPin& rig, const Frames& frames,
                          rt::Timestamp wake) noexcept;
  void compose(const Wanted& wanted, const RigPin& rig, const Frames& frames,
               hal::Scene& scene) noexcept;
  [[nodiscard]] bool mayDraw(const Wanted& wanted, rt::Timestamp now) noexcept;
  void noteViews() noexcept;
  void noteReady(const StoredFrame& frame) noexcept;
  void evenOut(hal::WarpPlan& plan, std::uint32_t camera) noexcept;
  void recordFlips() noexcept;
  void talkToGenlock() noexcept;

  const RenderParts parts_;
  const RenderParameters parameters_;
  TargetReader target_;
  MomentHold hold_second_;
  MomentHold hold_;  // before hold_second_: finds what both hold
  Director director_;
  ViewSet views_;
  ViewSet second_views_;  // of the second shot's target
  SightedViews sighted_;
  std::uint64_t on_arc_ = 0;  // the revision whose arc the director has

  // Since the last picture.
  std::array<Command, kMostCommands> commands_{};
  std::array<CommandId, kMostCommands> command_ids_{};
  std::size_t command_count_ = 0;
  rt::Timestamp first_command_;  // when the oldest of them was given; the epoch: none

  const hal::Overlay* overlay_ = nullptr;  // the newest; holds during a turn
  OverlaySubject subject_;                 // as said last
  Wanted on_screen_;
  rt::Timestamp shown_at_;
  bool stale_ = false;  // the screen lost that picture
  FlickerCompensation flicker_;
  RenderAllowance allowance_;
  bool held_back_ = false;               // the last new live moment was not drawn
  rt::HighQuantile ready_delay_;         // of live frames
  std::optional<LockedVblanks> locked_;  // none: triggers are not locked to the screen
  std::uint64_t picture_id_ = 0;
  RenderMetrics metrics_;
  RenderStatus counters_;
  rt::LatestValue<RenderStatus> status_;
  std::atomic<bool> screen_released_{false};
};

}  // namespace appliance
