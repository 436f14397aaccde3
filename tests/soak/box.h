#pragma once

#include <cmath>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "appliance/control/control_client.h"
#include "rt/clock.h"
#include "tests/support/child_process.h"

namespace soak {

struct BoxOptions {
  std::filesystem::path programs;  ///< the folder of kagamid and kagami-emulator
  std::filesystem::path folder;    ///< for everything that is written
  std::uint32_t cameras = 20;
  std::string size = "1280x1024";
  double rate_hz = 40;
  std::uint64_t seed = 1;
  /// From one trigger to the next.
  [[nodiscard]] rt::Nanoseconds period() const {
    return rt::Nanoseconds(std::llround(1e9 / rate_hz));
  }
};

/// The real programs, end to end: emulated cameras, a message bus of its own, and the daemon on a
/// offscreen display. Ended with the object.
class Box {
 public:
  /// Errors   One line: which program, why, and where its log is.
  [[nodiscard]] static std::expected<std::unique_ptr<Box>, std::string> start(
      const BoxOptions& options);

  [[nodiscard]] static std::filesystem::path tracePath(const std::filesystem::path& folder) {
    return folder / "trace.pipe";
  }
  [[nodiscard]] static std::filesystem::path wirePath(const std::filesystem::path& folder) {
    return folder / "wire.pipe";
  }

  /// @p camera from 0. Errors: what the emulator answered, or that it did not.
  [[nodiscard]] std::expected<void, std::string> fault(std::uint32_t camera,
                                                       std::string_view command) const;
  [[nodiscard]] int daemonPid() const { return daemon_->pid(); }
  /// The daemon's status as JSON.
  [[nodiscard]] std::expected<std::string, std::string> status() { return client_->status(); }
  /// Nothing, or which program has ended by itself.
  [[nodiscard]] std::string ended();

  /// Asks the program to stop and waits. Errors: it did not end, or not well.
  [[nodiscard]] std::expected<void, std::string> stopDaemon();
  [[nodiscard]] std::expected<void, std::string> stopEmulator();

 private:
  explicit Box(BoxOptions options) : options_(std::move(options)) {}
  std::expected<void, std::string> startEmulator();
  std::expected<void, std::string> startBus();
  std::expected<void, std::string> startDaemon();
  [[nodiscard]] std::string busAddress() const;

  BoxOptions options_;
  std::unique_ptr<test::ChildProcess> emulator_;
  std::unique_ptr<test::ChildProcess> bus_;
  std::unique_ptr<test::ChildProcess> daemon_;
  std::unique_ptr<appliance::ControlClient> client_;
};

}  // namespace soak
