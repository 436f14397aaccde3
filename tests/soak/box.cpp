#include "tests/soak/box.h"

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/support/fault_port.h"

namespace soak {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kFaultPort = 3991;
constexpr const char* kName = "org.kagami.Soak";
constexpr double kSlowestScreen_hz = 60;

std::string failed(const std::string& program, const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string line;
  std::string last;
  while (std::getline(file, line)) {
    if (!line.empty()) last = line;
  }
  return program + " failed: " + last + " (whole log: " + log.string() + ")";
}

std::expected<void, std::string> stop(test::ChildProcess& program, const std::string& name,
                                      const std::filesystem::path& log) {
  program.terminate();
  const auto status = program.wait(60s);
  if (!status) return std::unexpected(name + " did not end within a minute");
  if (*status != 0) return std::unexpected(failed(name, log));
  return {};
}

}  // namespace

std::expected<std::unique_ptr<Box>, std::string> Box::start(const BoxOptions& options) {
  std::unique_ptr<Box> box(new Box(options));
  auto done = box->startEmulator();
  if (done) done = box->startBus();
  if (done) done = box->startDaemon();
  if (!done) return std::unexpected(done.error());
  return box;
}

std::string Box::busAddress() const {
  return "unix:path=" + (options_.folder / "bus").string();
}

std::expected<void, std::string> Box::startEmulator() {
  const std::filesystem::path log = options_.folder / "emulator.log";
  emulator_ = std::make_unique<test::ChildProcess>(
      std::vector<std::string>{
          options_.programs / "kagami-emulator", "--cameras", std::to_string(options_.cameras),
          "--size", options_.size, "--rig-out", options_.folder / "rig.toml", "--wire-log",
          wirePath(options_.folder), "--stats", options_.folder / "emulator.json", "--fault-port",
          std::to_string(kFaultPort), "--fault-log", options_.folder / "faults.csv", "--seed",
          std::to_string(options_.seed),
          // Hardware is never late for want of a processor: above the daemon.
          "--realtime-priority", "85"},
      log, test::ProcessGroup::kOwn);
  if (!emulator_->waitForOutput("ready", 60s))
    return std::unexpected(failed("kagami-emulator", log));
  return {};
}

std::expected<void, std::string> Box::startBus() {
  const std::filesystem::path log = options_.folder / "bus.log";
  std::filesystem::remove(options_.folder / "bus");
  bus_ = std::make_unique<test::ChildProcess>(
      std::vector<std::string>{"/usr/bin/dbus-daemon", "--session", "--nofork", "--nopidfile",
                               "--print-address=1", "--address=" + busAddress()},
      log, test::ProcessGroup::kOwn);
  if (!bus_->waitForOutput("unix:", 20s)) return std::unexpected(failed("dbus-daemon", log));
  return {};
}

std::expected<void, std::string> Box::startDaemon() {
  const std::filesystem::path config = options_.folder / "kagamid.toml";
  const std::filesystem::path log = options_.folder / "kagamid.log";
  std::filesystem::create_directories(options_.folder / "state");
  std::string addresses;
  for (std::uint32_t i = 0; i < options_.cameras; ++i)
    addresses += (i == 0 ? "\"127.0.0." : ", \"127.0.0.") + std::to_string(i + 1) + "\"";
  double refresh_hz = options_.rate_hz;  // a multiple of the rate: every set has its picture
  while (refresh_hz < kSlowestScreen_hz) refresh_hz += options_.rate_hz;
  std::ofstream(config)
      << "[rig]\nfile = \"" << (options_.folder / "rig.toml").string()
      << "\"\n[cameras]\naddresses = [" << addresses
      << "]\n[trigger]\nrate_hz = " << options_.rate_hz
      << "\ngenlock = false\n[display]\nzoom = 1\nwidth_px = 640\nheight_px = 360\n"
      << "refresh_hz = " << refresh_hz << "\n[state]\ndirectory = \""
      << (options_.folder / "state").string() << "\"\ntrace = \""
      << tracePath(options_.folder).string() << "\"\n[control]\nbus = \"" << busAddress()
      << "\"\nname = \"" << kName << "\"\n";
  daemon_ = std::make_unique<test::ChildProcess>(
      std::vector<std::string>{options_.programs / "kagamid", "--config", config}, log,
      test::ProcessGroup::kOwn);
  if (!daemon_->waitForOutput("running: ", 120s)) return std::unexpected(failed("kagamid", log));
  auto client = appliance::ControlClient::open(busAddress(), kName);
  if (!client) return std::unexpected(client.error());
  client_ = std::make_unique<appliance::ControlClient>(std::move(*client));
  for (int attempt = 0; attempt < 50; ++attempt) {  // the interface opens just after that line
    if (client_->status()) return {};
    std::this_thread::sleep_for(100ms);
  }
  return std::unexpected("kagamid does not answer on its bus: " + client_->status().error());
}

std::expected<void, std::string> Box::fault(std::uint32_t camera, std::string_view command) const {
  const std::string text = std::to_string(camera + 1) + " " + std::string(command);
  const std::string answer = test::sendFault("127.0.0.1", kFaultPort, text);
  if (answer != "ok") return std::unexpected("fault \"" + text + "\": " + answer);
  return {};
}

std::string Box::ended() {
  if (daemon_->wait(0s)) return failed("kagamid", options_.folder / "kagamid.log");
  if (emulator_->wait(0s)) return failed("kagami-emulator", options_.folder / "emulator.log");
  return {};
}

std::expected<void, std::string> Box::stopDaemon() {
  return stop(*daemon_, "kagamid", options_.folder / "kagamid.log");
}

std::expected<void, std::string> Box::stopEmulator() {
  return stop(*emulator_, "kagami-emulator", options_.folder / "emulator.log");
}

}  // namespace soak
