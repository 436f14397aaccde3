// A GigE Vision camera that is not ours: Aravis' own fake camera, as an independent peer of
// kagamid.

#include <fstream>
#include <string>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/child_process.h"

namespace {

using namespace std::chrono_literals;

/// Somebody who listens on the trigger wire, so that the emulated line has a far end. The fake
/// camera has no hardware trigger and runs free at 25 Hz: beside triggers at 20 Hz its frames
/// come at every phase, and those in the first half of a period have an edge to go to.
class SilentWire {
 public:
  SilentWire() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bound_ = bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    socklen_t size = sizeof address;
    getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~SilentWire() { close(fd_); }
  SilentWire(const SilentWire&) = delete;
  SilentWire& operator=(const SilentWire&) = delete;

  [[nodiscard]] bool bound() const { return bound_; }
  [[nodiscard]] std::string port() const { return std::to_string(port_); }

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  bool bound_ = false;
  std::uint16_t port_ = 0;
};

constexpr const char* kRig = R"(format = 1
name = "one fake camera"
target_m = [0.0, 0.0, 1.0]
[[camera]]
name = "fake"
image_size_px = [512, 512]
focal_px = [500.0, 500.0]
centre_px = [255.5, 255.5]
distortion = [0.0, 0.0, 0.0, 0.0, 0.0]
T_cam_rig = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 1.0], [0.0, 1.0, 0.0, 4.0]]
gain_rgb = [1.0, 1.0, 1.0]
)";

TEST(FakeCameraOfAravis, IsConfiguredReceivedAndShownByTheDaemon) {
  const std::string fake = ARAVIS_FAKE_CAMERA;
  if (fake.ends_with("NOTFOUND")) GTEST_SKIP() << "arv-fake-gv-camera-0.8 is not installed";
  const test::TemporaryFolder folder;
  const SilentWire wire;
  ASSERT_TRUE(wire.bound());
  std::ofstream(folder / "rig.toml") << kRig;
  // It binds the address of a network interface only, so not one of 127.0.x.y of its own.
  test::ChildProcess camera({fake, "-i", "127.0.0.1", "-s", "kagami"}, folder / "camera.log");
  std::this_thread::sleep_for(1s);  // it says nothing when it is ready
  ASSERT_FALSE(camera.wait(0s)) << camera.output();
  test::ChildProcess daemon({KAGAMID,        "--config",
                             KAGAMID_CONFIG,                                                //
                             "--set",        "rig.file=" + (folder / "rig.toml").string(),  //
                             "--set",        R"(cameras.addresses=["127.0.0.1"])",          //
                             "--set",        "cameras.trigger_source=free-running",         //
                             "--set",        "cameras.packet_size_bytes=1500",              //
                             "--set",        "trigger.wire_port=" + wire.port(),            //
                             "--set",        "trigger.rate_hz=20",                          //
                             "--set",        "history.sets=40",                             //
                             "--set",        "control.bus=none",                            //
                             "--set",        "state.trace=" + (folder / "trace.jsonl").string()},
                            folder / "kagamid.log");
  ASSERT_TRUE(daemon.waitForOutput("running: 1 cameras", 60s)) << daemon.output();
  std::this_thread::sleep_for(3s);
  daemon.terminate();
  EXPECT_EQ(daemon.wait(60s), 0) << daemon.output();

  std::size_t stored = 0;
  std::size_t shown = 0;
  std::ifstream trace(folder / "trace.jsonl");
  for (std::string line; std::getline(trace, line);) {
    const auto record = nlohmann::json::parse(line);
    if (record["record"] == "frame" && record["trigger"] != 0) ++stored;
    if (record["record"] == "picture" && record["trigger"] != 0) ++shown;
  }
  EXPECT_GT(stored, 10U) << daemon.output();
  EXPECT_GT(shown, 10U) << daemon.output();
}

}  // namespace
