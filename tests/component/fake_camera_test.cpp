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

#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;

/// Listens on the trigger wire, so that the emulated line has a far end. The fake
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
  [[nodiscard]] int port() const { return port_; }

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
  test::ChildProcess daemon(
      test::kagamidCommand({.first_address = "127.0.0.1", .cameras = 1, .wire_port = wire.port()},
                           folder.path(),
                           {"cameras.trigger_source=free-running", "trigger.rate_hz=20",
                            "state.trace=" + (folder / "trace.jsonl").string()}),
      folder / "kagamid.log");
  ASSERT_TRUE(daemon.waitForOutput("running: 1 cameras", 60s)) << daemon.output();
  std::this_thread::sleep_for(3s);
  daemon.terminate();
  EXPECT_EQ(daemon.wait(60s), 0) << daemon.output();

  std::size_t stored = 0;
  std::size_t shown = 0;
  auto records = test::readTrace(folder / "trace.jsonl");
  for (const nlohmann::json& frame : records["frame"]) stored += frame["trigger"] != 0 ? 1 : 0;
  for (const nlohmann::json& picture : records["picture"]) shown += picture["trigger"] != 0 ? 1 : 0;
  EXPECT_GT(stored, 10U) << daemon.output();
  EXPECT_GT(shown, 10U) << daemon.output();
}

}  // namespace
