#pragma once

#include <expected>
#include <memory>
#include <span>
#include <string>

#include "appliance/control/bus_object.h"
#include "appliance/control/control_server.h"
#include "appliance/journal/status_journal.h"
#include "appliance/loop/event_loop.h"
#include "appliance/status/status.h"

namespace appliance {

/// What the main thread does while the box runs. Each tick takes one snapshot of the box; the D-Bus
/// interface, the journal and systemd's status line are all made from it. The watchdog is fed by a
/// timer of its own.
///
/// Threads  The event loop's. The sink and the source outlive the service.
/// Errors   Without a bus the box runs on: that is a line in the journal.
class BoxService {
 public:
  static constexpr rt::Nanoseconds kTick = std::chrono::milliseconds(100);
  static constexpr rt::Nanoseconds kWatchdog = std::chrono::milliseconds(200);
  /// How long the start waits for the name on the bus.
  static constexpr rt::Nanoseconds kWaitForName = std::chrono::seconds(2);

  /// Without a bus if @p place has none. @p objects are shown beside the box itself, and outlive
  /// the service.
  [[nodiscard]] static std::expected<std::unique_ptr<BoxService>, std::string> start(
      EventLoop& loop, const ControlServer::Place& place, ControlSink& sink,
      const StatusSource& source, JobRegistry& jobs, std::span<const BusObject> objects = {});

  BoxService(const BoxService&) = delete;
  BoxService& operator=(const BoxService&) = delete;

  /// Serves until a stop signal.
  [[nodiscard]] std::expected<void, std::string> run();

 private:
  BoxService(EventLoop& loop, const StatusSource& source) : loop_(loop), source_(source) {}

  void tick();
  void waitForName();
  [[nodiscard]] Condition controlCondition() const;

  EventLoop& loop_;
  const StatusSource& source_;
  std::unique_ptr<ControlServer> control_;  // none: not configured
  StatusJournal journal_;
  std::string service_text_;  // as systemd last got it
};

/// The box in one line, for `systemctl status`.
[[nodiscard]] std::string serviceText(const Status& status);

}  // namespace appliance
