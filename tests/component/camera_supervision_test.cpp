// Cameras that die, come back, are held by others or were never there: the daemon and the other
// cameras go on, and everything that comes back is taken back, without anybody's help.

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "rt/unique_fd.h"
#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/fault_port.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr int kCameras = 4;
const test::CameraNetwork kNetwork{
    .first_address = "127.0.7.1", .cameras = kCameras, .wire_port = 3987};
constexpr std::uint16_t kFaultPort = 3986;
constexpr auto kLong = 60s;  // far longer than anything here takes

sockaddr_in addressOf(const std::string& address, std::uint16_t port) {
  sockaddr_in socket_address{};
  socket_address.sin_family = AF_INET;
  socket_address.sin_port = htons(port);
  inet_pton(AF_INET, address.c_str(), &socket_address.sin_addr);
  return socket_address;
}

/// The far side of the wires, with the port that commands its cameras to fail.
class Rig {
 public:
  explicit Rig(const test::TemporaryFolder& folder)
      : process_(emulatorCommand(kNetwork, "640x480", folder.path(),
                                 {"--fault-port", std::to_string(kFaultPort)}),
                 folder / "emulator.log") {
    EXPECT_TRUE(process_.waitForOutput("ready", 30s)) << process_.output();
  }

  void fault(const std::string& command) const {
    EXPECT_EQ(test::sendFault(kNetwork.first_address, kFaultPort, command), "ok") << command;
  }

 private:
  test::ChildProcess process_;
};

class Daemon {
 public:
  Daemon(const test::TemporaryFolder& folder, const std::string& run)
      : trace_(folder / (run + ".jsonl")),
        process_(kagamidCommand(kNetwork, folder.path(),
                                {"trigger.rate_hz=20", "state.trace=" + trace_.string()}),
                 folder / (run + ".log")) {
    EXPECT_TRUE(says("running: 4 cameras"));
  }

  /// Whether it says @p text, now or soon.
  [[nodiscard]] bool says(const std::string& text) {
    const bool said = process_.waitForOutput(text, kLong);
    if (!said) ADD_FAILURE() << "'" << text << "' is not in:\n" << process_.output();
    return said;
  }
  [[nodiscard]] std::string output() const { return process_.output(); }
  void kill() {
    ::kill(process_.pid(), SIGKILL);
    (void)process_.wait(10s);
  }
  void stop() {
    process_.terminate();
    EXPECT_EQ(process_.wait(kLong), 0) << process_.output();
  }

  /// The triggers under which each camera's frames were stored, of the trace so far.
  [[nodiscard]] std::map<int, std::set<std::uint64_t>> stored() const {
    std::map<int, std::set<std::uint64_t>> triggers;
    auto records = test::readTrace(trace_);
    for (const json& frame : records["frame"]) {
      if (frame["trigger"] != 0) {
        triggers[frame["camera"]].insert(frame["trigger"].get<std::uint64_t>());
      }
    }
    return triggers;
  }
  /// Until every camera has stored a frame of a trigger after @p trigger.
  [[nodiscard]] bool allStoreAfter(std::uint64_t trigger) const {
    const auto end = std::chrono::steady_clock::now() + kLong;
    while (std::chrono::steady_clock::now() < end) {
      const auto frames = stored();
      int streaming = 0;
      for (const auto& [camera, triggers] : frames) streaming += *triggers.rbegin() > trigger;
      if (streaming == kCameras) return true;
      std::this_thread::sleep_for(100ms);
    }
    return false;
  }

 private:
  std::filesystem::path trace_;
  test::ChildProcess process_;
};

TEST(CameraSupervision, TakesEveryCameraBackWhileTheOthersLoseNothing) {
  const test::TemporaryFolder folder;
  const Rig rig(folder);
  Daemon daemon(folder, "kagamid");
  ASSERT_TRUE(daemon.allStoreAfter(10));

  rig.fault("2 kill");  // longer than its heartbeat: it forgets us
  ASSERT_TRUE(daemon.says("camera 2 (cam02): no frames for"));
  std::this_thread::sleep_for(4s);
  rig.fault("2 revive");
  ASSERT_TRUE(daemon.says("camera 2 (cam02): a frame for every trigger again"));

  rig.fault("3 kill");  // shorter: it is ours all the time
  ASSERT_TRUE(daemon.says("camera 3 (cam03): no frames for"));
  rig.fault("3 revive");
  ASSERT_TRUE(daemon.says("camera 3 (cam03): a frame for every trigger again"));

  rig.fault("4 reboot");  // settings and clock gone
  ASSERT_TRUE(daemon.says("camera 4 (cam04): no frames for"));
  ASSERT_TRUE(daemon.says("camera 4 (cam04): a frame for every trigger again"));
  daemon.stop();

  EXPECT_THAT(daemon.output(), HasSubstr("check its cable, its power and its switch port"));
  EXPECT_THAT(daemon.output(), Not(HasSubstr("camera 1 (cam01)")));
  auto frames = daemon.stored();
  const std::uint64_t last = *frames[0].rbegin();
  EXPECT_EQ(frames[0].size(), last) << "the camera that nothing happened to lost frames";
  for (const int camera : {1, 2, 3}) {
    std::uint64_t before = 0;
    int gaps = 0;
    for (const std::uint64_t trigger : frames[camera]) {
      gaps += trigger != before + 1;
      before = trigger;
    }
    EXPECT_EQ(gaps, 1) << "camera " << camera + 1 << " lost frames while another was away";
    EXPECT_GT(*frames[camera].rbegin() + 10, last) << "camera " << camera + 1;
  }
}

TEST(CameraSupervision, TakesEverythingBackAfterItsOwnCrash) {
  const test::TemporaryFolder folder;
  const Rig rig(folder);
  {
    Daemon crashed(folder, "crashed");
    ASSERT_TRUE(crashed.allStoreAfter(10));
    crashed.kill();  // each camera believes in its controller until its heartbeat ends
  }
  Daemon daemon(folder, "kagamid");
  EXPECT_TRUE(daemon.allStoreAfter(20)) << daemon.output();
  daemon.stop();
}

TEST(CameraSupervision, StartsWithoutAnyCameraAndTakesThemWhenTheyCome) {
  const test::TemporaryFolder folder;
  {
    const Rig rig(folder);
  }  // for its geometry
  Daemon daemon(folder, "kagamid");
  ASSERT_TRUE(daemon.says("camera 4 (cam04): no answer: check its cable"));
  const Rig rig(folder);
  for (int camera = 1; camera <= kCameras; ++camera) {
    ASSERT_TRUE(daemon.says("camera " + std::to_string(camera) + " (cam0" + std::to_string(camera) +
                            "): a frame for every trigger again"));
  }
  daemon.stop();
}

/// Another program that controls a camera and keeps its heart beating.
class ForeignController {
 public:
  explicit ForeignController(const std::string& camera) {
    const sockaddr_in there = addressOf(camera, 3956);
    EXPECT_EQ(::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there), 0);
    const timeval patience{.tv_sec = 10, .tv_usec = 0};
    setsockopt(fd_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    // Write 2, control, into the control privilege register.
    const auto taken = ask({0x42, 1, 0, 0x82, 0, 8, 0, 1, 0, 0, 0x0a, 0, 0, 0, 0, 2});
    EXPECT_TRUE(taken) << "the camera is not free";
    heart_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        EXPECT_TRUE(ask({0x42, 1, 0, 0x80, 0, 4, 0, 1, 0, 0, 0x0a, 0}));
        std::this_thread::sleep_for(200ms);
      }
    });
  }

 private:
  [[nodiscard]] bool ask(const std::vector<std::uint8_t>& question) const {
    (void)::send(fd_.get(), question.data(), question.size(), 0);
    std::array<std::uint8_t, 64> answer{};
    return ::recv(fd_.get(), answer.data(), answer.size(), 0) >= 8 && answer[0] == 0;
  }

  rt::UniqueFd fd_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::jthread heart_;
};

TEST(CameraSupervision, LeavesACameraToALivingControllerSaysSoAndTakesItWhenItIsFree) {
  const test::TemporaryFolder folder;
  const Rig rig(folder);
  auto foreign = std::make_unique<ForeignController>("127.0.7.3");
  Daemon daemon(folder, "kagamid");
  ASSERT_TRUE(daemon.says("camera 3 (cam03): in use by another program"));
  foreign.reset();
  ASSERT_TRUE(daemon.says("camera 3 (cam03): a frame for every trigger again"));
  daemon.stop();
  EXPECT_THAT(daemon.output(), Not(HasSubstr("camera 2 (cam02)")));
}

TEST(CameraSupervision, TwoDaemonsShareTheRigOnlyOneAfterTheOther) {
  const test::TemporaryFolder folder;
  const Rig rig(folder);
  auto first = std::make_unique<Daemon>(folder, "first");
  ASSERT_TRUE(first->allStoreAfter(5));
  Daemon second(folder, "second");
  ASSERT_TRUE(second.says("camera 1 (cam01): in use by another program"));
  EXPECT_TRUE(second.stored().empty()) << "its triggers fire, but the cameras are not its own";
  first->stop();
  EXPECT_TRUE(second.allStoreAfter(0)) << second.output();
  second.stop();
}

}  // namespace
