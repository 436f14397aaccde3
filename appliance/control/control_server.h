#pragma once

#include <expected>
#include <memory>
#include <string>

#include "appliance/status/status.h"
#include "rt/clock.h"

namespace appliance {

/// The daemon's D-Bus interface: object /org/kagami/Kagami1, interface org.kagami.Kagami1.
///
/// Arguments are checked here: what is wrong goes back to the caller as an error of one line,
/// and nothing invalid reaches the sink. Views count from 1 on the bus.
///
/// Threads  One at a time, SCHED_OTHER: main, between its ticks. The sink and the
///          source are called from process() only, and outlive the server.
/// RT       Nothing here is RT safe.
/// Errors   A bus that is not there, or that goes away, is an outcome with one line that says
///          what does not work and what to do: the daemon goes on without it.
class ControlServer {
 public:
  /// @p bus: "system", "session" or a D-Bus address; @p name: the well-known name to own.
  [[nodiscard]] static std::expected<std::unique_ptr<ControlServer>, std::string> open(
      const std::string& bus, const std::string& name, ControlSink& sink,
      const StatusSource& source);

  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  /// Returns when there is something to process(), a signal came, or after @p timeout.
  void wait(rt::Nanoseconds timeout);

  /// Answers everything that came; never blocks. After an error the server is of no further use.
  [[nodiscard]] std::expected<void, std::string> process();

  struct Implementation;  // keeps sd-bus out of every includer

 private:
  explicit ControlServer(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace appliance
