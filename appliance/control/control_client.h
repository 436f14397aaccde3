#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>

#include "appliance/control/bus.h"
#include "appliance/jobs/job_work.h"

namespace appliance {

/// The far side of the control interface, for the command line.
///
/// Threads  One.
/// RT       Blocks, up to D-Bus's own timeout.
/// Errors   One line: no bus, no daemon (and how to start it), or what the daemon refused.
class ControlClient {
 public:
  [[nodiscard]] static std::expected<ControlClient, std::string> open(const std::string& bus,
                                                                      const std::string& name);

  using Answer = std::expected<void, std::string>;
  [[nodiscard]] Answer setMode(const std::string& mode);
  [[nodiscard]] Answer setDelay(std::uint32_t delay_ms);
  [[nodiscard]] Answer setView(std::uint32_t view);  ///< from 1
  [[nodiscard]] Answer setSpeed(const std::string& rate);
  [[nodiscard]] Answer replay(std::uint32_t delay_ms, const std::string& rate);
  /// @p view: from 1; 0: the first shot's.
  [[nodiscard]] Answer compare(const std::string& layout, std::uint32_t view,
                               std::uint32_t earlier_ms, double share);
  [[nodiscard]] Answer setTarget(const std::array<double, 3>& target_m);
  [[nodiscard]] Answer releaseTarget();
  [[nodiscard]] Answer freeze();
  [[nodiscard]] Answer thaw();
  [[nodiscard]] Answer sweep();
  /// Until takeScreen() or the end of this client.
  [[nodiscard]] Answer releaseScreen();
  [[nodiscard]] Answer takeScreen();
  /// What was ignored in it, one line each.
  [[nodiscard]] std::expected<std::string, std::string> loadRig(const std::string& text,
                                                                const std::string& name);
  /// The path of the job that writes the depth sensor's newest @p pairs.
  [[nodiscard]] std::expected<std::string, std::string> snapshotDepth(std::uint32_t pairs);
  /// How the job of that path stands.
  [[nodiscard]] std::expected<JobReport, std::string> job(const std::string& path);
  [[nodiscard]] Answer cancelJob(const std::string& path);
  /// The JSON of appliance::toJson(Status).
  [[nodiscard]] std::expected<std::string, std::string> status();
  /// The JSON of appliance::toJson(MetricsSnapshot).
  [[nodiscard]] std::expected<std::string, std::string> metrics();

 private:
  ControlClient(Bus bus, std::string bus_name, std::string name);
  struct Object {
    const char* path;
    const char* missing;  ///< the reason if it is not there
  };
  /// A method of the box itself; its answer is nothing or one text.
  template <class... Arguments>
  std::expected<std::string, std::string> call(const char* interface, const char* method,
                                               const char* types, Arguments... arguments);
  template <class... Arguments>
  std::expected<std::string, std::string> callAt(const Object& object, const char* interface,
                                                 const char* method, const char* types,
                                                 Arguments... arguments);
  [[nodiscard]] std::string reasonOf(const sd_bus_error& error, int result, const char* method,
                                     const Object& object) const;

  Bus bus_;
  std::string bus_name_;
  std::string name_;
};

}  // namespace appliance
