#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "appliance/capture/camera_array.h"
#include "appliance/capture/collector.h"
#include "appliance/capture/frame_history.h"
#include "appliance/capture/loopback.h"
#include "appliance/capture/trigger_loop.h"
#include "appliance/config/config.h"
#include "appliance/control/status.h"
#include "appliance/depth/depth_loop.h"
#include "appliance/geometry/rig.h"
#include "appliance/geometry/target_track.h"
#include "appliance/panel/panel_loop.h"
#include "appliance/render/history_views.h"
#include "appliance/render/render_loop.h"
#include "appliance/trace/trace_writer.h"
#include "hal/button_panel.h"
#include "hal/display.h"
#include "hal/edge_input.h"
#include "hal/trigger_line.h"
#include "rt/thread.h"

namespace appliance {

/// The running pipeline: trigger line -> cameras -> frame history -> director -> display.
///
/// start() sets everything up before the real-time threads see it, and fires the first trigger
/// last; stop() goes the other way. A camera that does not open is named and tried again for as
/// long as it takes; the rest runs on.
///
/// Threads  All members: the owner (main), which serves the control interface too. The threads
///          it starts are those of docs/real-time.md.
/// Errors   start(): one line for a person; nothing is left running.
class Appliance final : public ControlSink, public StatusSource {
 public:
  /// @p display and @p observer outlive the appliance. @p degraded: what is known already not to
  /// be as asked.
  [[nodiscard]] static std::expected<std::unique_ptr<Appliance>, std::string> start(
      const Config& config, const Rig& rig, hal::Display& display, PictureObserver* observer,
      std::vector<std::string> degraded);

  ~Appliance() override;
  Appliance(const Appliance&) = delete;
  Appliance& operator=(const Appliance&) = delete;

  /// Stops the trigger, waits for the frames on the wire, then everything else.
  /// Errors: the trace could not be written whole.
  std::expected<void, std::string> stop();

  [[nodiscard]] bool command(const Command& command) override;
  [[nodiscard]] bool setTarget(const std::array<double, 3>& target_m) override;
  void releaseTarget() override;
  void setScreenReleased(bool released) override;
  [[nodiscard]] Status status() const override;

 private:
  Appliance(const Config& config, const Rig& rig);

  [[nodiscard]] std::expected<void, std::string> makeHistory(const hal::Display& display);
  [[nodiscard]] std::expected<void, std::string> openDevices();
  void openPanel();
  void openDepthSensor();
  [[nodiscard]] std::expected<void, std::string> openTrace();
  void makeLoops(hal::Display& display, PictureObserver* observer);
  [[nodiscard]] std::expected<void, std::string> startThreads(const hal::Display& display);
  [[nodiscard]] std::expected<void, std::string> startThread(rt::Thread& thread, const char* name,
                                                             const ThreadSchedule& how,
                                                             std::function<void(std::stop_token)>);
  void stopPipeline();
  [[nodiscard]] rt::Timestamp shownExposure() const;
  [[nodiscard]] RunRecord runRecord(const hal::Display& display) const;
  [[nodiscard]] SummaryRecord summary() const;

  const Config config_;
  const Rig rig_;
  const rt::Nanoseconds period_;
  std::vector<std::string> degraded_;  // what is less than configured, a line each

  std::string renderer_;
  std::string source_path_;  // how frames reach the renderer
  TargetTrack target_;
  DepthBoard depth_board_;
  CaptureBoard board_;
  std::unique_ptr<FrameHistory> history_;
  std::unique_ptr<HistoryViews> shown_frames_;  // through the render loop's reader
  std::unique_ptr<hal::TriggerLine> trigger_line_;
  std::unique_ptr<hal::EdgeInput> loopback_;  // none: no loop-back, or wired wrongly
  std::unique_ptr<hal::ButtonPanel> panel_;
  std::unique_ptr<TraceWriter> trace_;  // none: not traced
  std::unique_ptr<CameraArray> cameras_;
  std::unique_ptr<TriggerLoop> trigger_loop_;
  std::unique_ptr<LoopbackLoop> loopback_loop_;
  std::unique_ptr<RenderLoop> render_loop_;
  std::unique_ptr<PanelLoop> panel_loop_;
  std::unique_ptr<DepthLoop> depth_loop_;  // none: no sensor

  rt::Thread loopback_thread_;
  rt::Thread panel_thread_;
  rt::Thread depth_thread_;
  rt::Thread render_thread_;
  rt::Thread trigger_thread_;
};

}  // namespace appliance
