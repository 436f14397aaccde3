#pragma once

#include <memory>
#include <string>

#include "appliance/control/bus_object.h"
#include "appliance/jobs/job_registry.h"
#include "appliance/loop/event_loop.h"
#include "appliance/status/status.h"
#include "rt/clock.h"

namespace appliance {

/// The daemon's D-Bus interface: object /org/kagami/Kagami1 with one interface per right:
/// org.kagami.Kagami1 to look, .Control to operate, .Maintenance to maintain. docs/dbus.md is the
/// reference.
///
/// Everything that is read comes from the snapshot of the last tick(). Arguments are checked here:
/// what is wrong goes back to the caller as an error of one line, and nothing invalid reaches the
/// sink. Views count from 1 on the bus.
///
/// A command is answered when the director has carried it out, or with an error that says why not.
///
/// Threads  The event loop's. Sink, source and jobs outlive the server.
/// RT       Nothing here is RT safe.
/// Errors   A bus that is not there, or that goes away, is an outcome: it is tried again, and
///          trouble() says so.
class ControlServer {
 public:
  struct Place {
    std::string bus;   ///< "system", "session" or a D-Bus address
    std::string name;  ///< the well-known name to own
  };

  ControlServer(EventLoop& loop, Place place, ControlSink& sink, const StatusSource& source,
                JobRegistry& jobs);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  /// Shows one more interface of an object; before the first tick().
  void show(const BusObject& object);

  /// Takes the answers of the director that have come. Their callers get them at the next tick(),
  /// whose status was taken after this, so that it shows the effect.
  void collectAnswers();

  /// Takes the status that is shown from now on, signals what changed, answers what waited, and
  /// looks after the connection.
  void tick(rt::Timestamp now, Status status);

  [[nodiscard]] bool connected() const;
  /// Why there is no control interface; empty: nothing wrong, or not known yet.
  [[nodiscard]] std::string trouble() const;
  /// "org.kagami.Kagami1 on the system bus"
  [[nodiscard]] std::string title() const;

  struct Implementation;  // keeps sd-bus's tables out of every includer

 private:
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace appliance
