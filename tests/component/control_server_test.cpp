#include "appliance/control/control_server.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appliance/control/control_client.h"
#include "tests/support/private_bus.h"

namespace {

using appliance::Command;
using appliance::ControlClient;
using appliance::ControlServer;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr const char* kName = "org.kagami.Kagami1";

/// The daemon's side of both interfaces: keeps what came, answers with a fixed status.
class Box : public appliance::ControlSink, public appliance::StatusSource {
 public:
  bool command(const Command& command) override {
    const std::scoped_lock lock(mutex_);
    if (full_) return false;
    commands_.push_back(command);
    return true;
  }
  bool setTarget(const std::array<double, 3>& target_m) override {
    const std::scoped_lock lock(mutex_);
    target_m_ = target_m;
    return true;
  }
  void releaseTarget() override {
    const std::scoped_lock lock(mutex_);
    target_m_ = {0, 0, 1};
  }
  void setScreenReleased(bool released) override {
    const std::scoped_lock lock(mutex_);
    screen_ = released ? hal::ScreenState::kReleased : hal::ScreenState::kShowing;
  }
  [[nodiscard]] appliance::Status status() const override {
    const std::scoped_lock lock(mutex_);
    appliance::Status status;
    status.mode = appliance::Mode::kDelayed;
    status.view_wanted = 6;
    status.view_shown = 7;
    status.delay_ms = 1500;
    status.history_ms = 7500;
    status.target_m = target_m_;
    status.shown_hz = 39.5;
    status.screen = screen_;
    status.frames_lost = 3;
    for (int i = 1; i <= 20; ++i)
      status.cameras.push_back(
          {.name = "cam" + std::to_string(i), .state = appliance::CameraState::kStreaming});
    status.cameras[6].state = appliance::CameraState::kLost;
    status.cameras[6].reason = "no frames since 0.4 s: check its cable";
    status.cameras[6].frames_lost = 3;
    status.degraded = {{"memory", "memory is not locked"}, {"camera 7", "view 7 \"rear\" is lost"}};
    return status;
  }
  void fill() {
    const std::scoped_lock lock(mutex_);
    full_ = true;
  }
  [[nodiscard]] std::vector<Command> commands() const {
    const std::scoped_lock lock(mutex_);
    return commands_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Command> commands_;
  std::array<double, 3> target_m_{0, 0, 1};
  bool full_ = false;
  hal::ScreenState screen_ = hal::ScreenState::kShowing;
};

class ControlInterface : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty())
      GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
    auto opened = ControlServer::open(bus_.address(), kName, box_, box_);
    ASSERT_TRUE(opened.has_value()) << opened.error();
    server_ = std::move(*opened);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        const auto processed = server_->process();
        if (!processed) {
          fault_ = processed.error();
          return;
        }
        server_->wait(milliseconds(20));
      }
    });
  }

  [[nodiscard]] ControlClient client() const {
    auto opened = ControlClient::open(bus_.address(), kName);
    EXPECT_TRUE(opened.has_value()) << opened.error();
    return std::move(*opened);
  }

  test::PrivateBus bus_;
  Box box_;
  std::unique_ptr<ControlServer> server_;
  std::string fault_;  // read after the thread is joined
  std::jthread thread_;
};

TEST_F(ControlInterface, CarriesCommandsToTheSink) {
  ControlClient kagami = client();
  EXPECT_TRUE(kagami.setMode("live").has_value());
  EXPECT_TRUE(kagami.setDelay(2500).has_value());
  EXPECT_TRUE(kagami.setView(20).has_value());
  EXPECT_TRUE(kagami.freeze().has_value());
  EXPECT_TRUE(kagami.sweep().has_value());
  EXPECT_THAT(
      box_.commands(),
      testing::ElementsAre(Command{Command::Kind::kGoLive},
                           Command{.kind = Command::Kind::kSetDelay, .delay = milliseconds(2500)},
                           Command{.kind = Command::Kind::kSetView, .camera = 19},
                           Command{Command::Kind::kFreezeToggle}, Command{Command::Kind::kSweep}));
  EXPECT_TRUE(kagami.setTarget({1, 2, 0.5}).has_value());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{1, 2, 0.5}));
  EXPECT_TRUE(kagami.releaseTarget().has_value());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{0, 0, 1}));
  EXPECT_TRUE(kagami.releaseScreen().has_value());
  EXPECT_EQ(box_.status().screen, hal::ScreenState::kReleased);
  EXPECT_THAT(kagami.status().value(), HasSubstr("\"state\":\"released\""));
  EXPECT_TRUE(kagami.takeScreen().has_value());
  EXPECT_EQ(box_.status().screen, hal::ScreenState::kShowing);
}

TEST_F(ControlInterface, RefusesInvalidArgumentsWithOneLineAndChangesNothing) {
  ControlClient kagami = client();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(kagami.setTarget({nan, 0, 0}).error(), HasSubstr("not three coordinates"));
  EXPECT_THAT(kagami.setView(0).error(), HasSubstr("the views are 1 to 20"));
  EXPECT_THAT(kagami.setView(21).error(), HasSubstr("there is no view 21"));
  EXPECT_THAT(kagami.setMode("backwards").error(), HasSubstr("unknown mode \"backwards\""));
  EXPECT_THAT(kagami.setDelay(60'000).error(), HasSubstr("longer than the stored"));
  EXPECT_TRUE(box_.commands().empty());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{0, 0, 1}));
}

TEST_F(ControlInterface, SaysWhenTheDirectorTakesNoMore) {
  box_.fill();
  EXPECT_THAT(client().freeze().error(), HasSubstr("try again"));
}

TEST_F(ControlInterface, StatusIsOneJsonObjectWithViewsFromOne) {
  const auto text = client().status();
  ASSERT_TRUE(text.has_value()) << text.error();
  const auto status = nlohmann::json::parse(*text);
  EXPECT_EQ(status["mode"], "delayed");
  EXPECT_EQ(status["view_wanted"], 7);
  EXPECT_EQ(status["view_shown"], 8);
  EXPECT_EQ(status["delay_ms"], 1500);
  ASSERT_EQ(status["cameras"].size(), 20u);
  EXPECT_EQ(status["cameras"][6]["state"], "lost");
  EXPECT_EQ(status["cameras"][6]["frames_lost"], 3);
  EXPECT_EQ(status["degraded"][0], "memory is not locked");
}

std::string outputOf(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> chunk{};
  while (std::fgets(chunk.data(), chunk.size(), pipe) != nullptr) text += chunk.data();
  pclose(pipe);
  return text;
}

TEST_F(ControlInterface, IsIntrospectableAndReadableByBusctl) {
  const std::string busctl = "busctl --address='" + bus_.address() + "' ";
  if (outputOf("busctl --version").find("systemd") == std::string::npos)
    GTEST_SKIP() << "busctl is not installed (package systemd)";
  const std::string object = " org.kagami.Kagami1 /org/kagami/Kagami1 ";
  const std::string seen = outputOf(busctl + "introspect" + object);
  for (const char* name :
       {".SetMode",  ".SetDelay", ".SetView",  ".SetTarget",     ".Freeze",           ".Sweep",
        ".Status",   ".Mode",     ".View",     ".ViewShown",     ".DelayMs",          ".HistoryMs",
        ".Target",   ".ShownHz",  ".Triggers", ".FramesLost",    ".FramesIncomplete", ".Cameras",
        ".Degraded", ".Renderer", ".Screen",   ".ReleaseScreen", ".TakeScreen"})
    EXPECT_THAT(seen, HasSubstr(std::string(name) + " "));
  const std::string property = "get-property" + object + "org.kagami.Kagami1 ";
  EXPECT_EQ(outputOf(busctl + property + "View"), "u 7\n");
  EXPECT_EQ(outputOf(busctl + property + "Target"), "(ddd) 0 0 1\n");
  EXPECT_EQ(outputOf(busctl + property + "Mode"), "s \"delayed\"\n");
  EXPECT_THAT(outputOf(busctl + property + "Cameras"), HasSubstr("\"cam7\" \"lost\" 3 0"));
  EXPECT_THAT(outputOf(busctl + property + "CameraReasons"),
              HasSubstr("\"no frames since 0.4 s: check its cable\""));
  EXPECT_THAT(outputOf(busctl + "call" + object + "org.kagami.Kagami1 SetView u 99"),
              HasSubstr("there is no view 99"));
}

TEST_F(ControlInterface, ASecondDaemonOnTheSameBusIsToldSo) {
  const auto second = ControlServer::open(bus_.address(), kName, box_, box_);
  ASSERT_FALSE(second.has_value());
  EXPECT_THAT(second.error(), HasSubstr("another kagamid"));
}

TEST_F(ControlInterface, ABusThatGoesAwayIsAnOutcome) {
  bus_.stop();
  thread_.join();  // it ends by itself: process() said so
  EXPECT_THAT(fault_, HasSubstr("no control interface: lost the bus"));
}

TEST(ControlBus, AnUnreachableBusIsAnOutcome) {
  Box box;
  const auto server = ControlServer::open("unix:path=/nonexistent/bus", kName, box, box);
  ASSERT_FALSE(server.has_value());
  EXPECT_THAT(server.error(), HasSubstr("cannot reach the bus unix:path=/nonexistent/bus"));
  EXPECT_THAT(ControlClient::open("not an address", kName).error(), HasSubstr("cannot reach"));
}

TEST(ControlBus, AMissingDaemonIsNamedWithTheWayToStartIt) {
  const test::PrivateBus bus;
  if (bus.address().empty())
    GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
  auto kagami = ControlClient::open(bus.address(), kName);
  ASSERT_TRUE(kagami.has_value()) << kagami.error();
  EXPECT_THAT(kagami->status().error(), testing::AllOf(HasSubstr("kagamid is not running"),
                                                       HasSubstr("systemctl start kagamid")));
}

}  // namespace
