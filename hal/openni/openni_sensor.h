#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "hal/depth_sensor.h"
#include "hal/openni/clock_fit.h"
#include "hal/openni/play_clock.h"
#include "hal/openni/restart_pause.h"
#include "hal/openni/worker_process.h"
#include "rt/clock.h"

namespace hal::openni {

/// What is set besides the settings of every depth sensor.
struct SensorOptions {
  Play play = Play::kRealTime;  ///< of a recording
  /// A worker that says nothing for so long before its first picture is ended.
  rt::Nanoseconds opening_patience = std::chrono::seconds(10);
};

/// A sensor, or a recording of one, through OpenNI2.
///
/// OpenNI2 and its drivers run in a process of their own, kagami-depth: a driver that blocks,
/// crashes or loses its sensor for good costs that process, and a new one starts. A sensor
/// that says nothing for a second is taken for lost.
///
/// Threads  waitFrame(): one caller. status(): any.
/// Errors   open(): never fails because there is no sensor; status() reports that.
class OpenniSensor final : public DepthSensor {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<OpenniSensor>, std::string> open(
      const DepthSensorSettings& settings, const SensorOptions& options = {});

  [[nodiscard]] std::optional<DepthFrame> waitFrame(rt::Nanoseconds timeout) override;
  [[nodiscard]] DepthStatus status() const override;

 private:
  OpenniSensor(DepthSensorSettings settings, SensorOptions options, WorkerProcess worker);

  /// One step: what came from the worker, or the next worker, or a wait until @p until at most.
  void turn(rt::Timestamp until);
  void onMessage(Received& received);
  void onHello(const WireMessage& message, rt::UniqueFd memory);
  void onFrame(const WireMessage& message);
  void onEnd();
  void lose(const std::string& why, RestartPause::End end = RestartPause::End::kFailure);
  void setExposures(const WireMessage& message);
  [[nodiscard]] rt::Timestamp silentUntil() const;
  [[nodiscard]] DepthFrame frameOf(const WireMessage& message);

  template <class Change>
  void note(const Change& change) {
    const std::scoped_lock lock(mutex_);
    change(status_);
  }

  const DepthSensorSettings settings_;
  const SensorOptions options_;
  std::optional<WorkerProcess> worker_;
  rt::Timestamp heard_;     // of the worker
  rt::Timestamp start_at_;  // of the next one
  RestartPause pause_;
  std::optional<ClockFit> clock_;
  PlayClock play_clock_;
  std::uint64_t last_number_ = 0;
  std::optional<WireMessage> due_;  // received, and not shown yet
  rt::Timestamp due_exposure_;
  rt::Timestamp due_colour_exposure_;
  std::optional<std::uint32_t> lent_;  // the slot the caller looks at
  bool streamed_ = false;              // this worker, once
  bool was_lost_ = false;

  mutable std::mutex mutex_;  // guards status_
  DepthStatus status_;
};

}  // namespace hal::openni
