#include "appliance/control/control_server.h"

#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appliance/control/control_client.h"
#include "appliance/jobs/job_thread.h"
#include "tests/support/becomes_true.h"
#include "tests/support/control_daemon.h"
#include "tests/support/output_of.h"
#include "tests/support/private_bus.h"

namespace {

using appliance::Command;
using appliance::ControlClient;
using appliance::Rate;
using std::chrono::milliseconds;
using test::Box;
using test::Daemon;
using test::kName;
using testing::ElementsAre;
using testing::HasSubstr;

class ControlInterface : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty())
      GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
    daemon_.emplace(bus_.address(), box_, jobs_);
    ASSERT_TRUE(daemon_->waitUntilConnected()) << daemon_->trouble();
  }

  [[nodiscard]] ControlClient client() const {
    auto opened = ControlClient::open(bus_.address(), kName);
    EXPECT_TRUE(opened.has_value()) << opened.error();
    return std::move(*opened);
  }

  test::PrivateBus bus_;
  Box box_;
  appliance::JobRegistry jobs_;  // the daemon's thread has it while it runs
  std::optional<Daemon> daemon_;
};

TEST_F(ControlInterface, CarriesCommandsToTheSink) {
  ControlClient kagami = client();
  EXPECT_TRUE(kagami.setMode("live").has_value());
  EXPECT_TRUE(kagami.setDelay(2500).has_value());
  EXPECT_TRUE(kagami.setView(20).has_value());
  EXPECT_TRUE(kagami.freeze().has_value());
  EXPECT_TRUE(kagami.thaw().has_value());
  EXPECT_TRUE(kagami.sweep().has_value());
  EXPECT_TRUE(kagami.setSpeed("1/4").has_value());
  EXPECT_TRUE(kagami.replay(2000, "1/8").has_value());
  EXPECT_TRUE(kagami.compare("ghost", 3, 1500, 0.25).has_value());
  EXPECT_THAT(
      box_.commands(),
      ElementsAre(
          Command{Command::Kind::kGoLive},
          Command{.kind = Command::Kind::kSetDelay, .delay = milliseconds(2500)},
          Command{.kind = Command::Kind::kSetView, .camera = 19}, Command{Command::Kind::kFreeze},
          Command{Command::Kind::kThaw}, Command{Command::Kind::kStartSweep},
          Command{.kind = Command::Kind::kSetRate, .rate = Rate::kQuarter},
          Command{
              .kind = Command::Kind::kReplay, .delay = milliseconds(2000), .rate = Rate::kEighth},
          Command{.kind = Command::Kind::kCompare,
                  .camera = 2,
                  .delay = milliseconds(1500),
                  .composition = {.layout = appliance::Layout::kGhost, .share = 0.25F}}));
  EXPECT_TRUE(kagami.setTarget({1, 2, 0.5}).has_value());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{1, 2, 0.5}));
  EXPECT_TRUE(kagami.releaseTarget().has_value());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{0, 0, 1}));
  EXPECT_TRUE(kagami.releaseScreen().has_value());
  EXPECT_EQ(box_.status().screen, hal::ScreenState::kReleased);
  EXPECT_TRUE(test::becomesTrue(
      [&] { return kagami.status().value().find("\"state\":\"released\"") != std::string::npos; }));
  EXPECT_TRUE(kagami.takeScreen().has_value());
  EXPECT_EQ(box_.status().screen, hal::ScreenState::kShowing);
}

TEST_F(ControlInterface, HandsARigFileToTheBoxAndItsWarningsBack) {
  ControlClient kagami = client();
  EXPECT_EQ(kagami.loadRig("format = 2\nmirror = 1\n", "rig.toml"), "rig.toml:2: ignored\n");
  EXPECT_EQ(box_.rigText(), "format = 2\nmirror = 1\n");
  EXPECT_EQ(kagami.loadRig("{", "rig.toml").error(), "rig.toml:1: no rig");
  const std::string huge(2U << 20, '#');
  EXPECT_THAT(kagami.loadRig(huge, "rig.toml").error(), HasSubstr("larger than 1 MiB"));
  EXPECT_EQ(box_.rigText(), "format = 2\nmirror = 1\n");
}

TEST_F(ControlInterface, RefusesInvalidArgumentsWithOneLineAndChangesNothing) {
  ControlClient kagami = client();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(kagami.setTarget({nan, 0, 0}).error(), HasSubstr("not three coordinates"));
  EXPECT_THAT(kagami.setView(0).error(), HasSubstr("the views are 1 to 20"));
  EXPECT_THAT(kagami.setView(21).error(), HasSubstr("there is no view 21"));
  EXPECT_THAT(kagami.setMode("backwards").error(), HasSubstr("unknown mode \"backwards\""));
  EXPECT_THAT(kagami.setDelay(60'000).error(), HasSubstr("longer than the stored"));
  EXPECT_THAT(kagami.setSpeed("2").error(), HasSubstr("the speeds are"));
  EXPECT_TRUE(box_.commands().empty());
  EXPECT_EQ(box_.status().target_m, (std::array<double, 3>{0, 0, 1}));
}

TEST_F(ControlInterface, SaysWhenTheDirectorTakesNoMore) {
  box_.fill();
  EXPECT_THAT(client().freeze().error(), HasSubstr("try again"));
}

TEST_F(ControlInterface, ACommandThatTheDirectorRefusesSaysWhy) {
  box_.answerWith(appliance::CommandOutcome::kNoPictureYet);
  EXPECT_THAT(client().freeze().error(), HasSubstr("no picture was shown yet"));
}

TEST_F(ControlInterface, ACommandIsAnsweredWhenItIsCarriedOutAndNotBefore) {
  box_.answerWith(std::nullopt);
  const rt::Timestamp begin = rt::now();
  EXPECT_THAT(client().freeze().error(), HasSubstr("has not carried it out within 1 s"));
  EXPECT_GE(rt::now() - begin, milliseconds(1000));
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

TEST_F(ControlInterface, IsReadableByBusctl) {
  const std::string busctl = "busctl --address='" + bus_.address() + "' ";
  if (test::outputOf("busctl --version").find("systemd") == std::string::npos)
    GTEST_SKIP() << "busctl is not installed (package systemd)";
  const std::string object = " org.kagami.Kagami1 /org/kagami/Kagami1 ";
  const std::string property = "get-property" + object + "org.kagami.Kagami1 ";
  EXPECT_EQ(test::outputOf(busctl + property + "View"), "u 7\n");
  EXPECT_EQ(test::outputOf(busctl + property + "Target"), "(ddd) 0 0 1\n");
  EXPECT_EQ(test::outputOf(busctl + property + "Mode"), "s \"delayed\"\n");
  EXPECT_THAT(test::outputOf(busctl + property + "Cameras"),
              AllOf(HasSubstr("\"Name\" s \"cam7\" \"State\" s \"lost\""),
                    HasSubstr("\"Reason\" s \"no frames since 0.4 s: check its cable\"")));
  EXPECT_THAT(test::outputOf(busctl + "call" + object + "org.kagami.Kagami1.Control SetView u 99"),
              HasSubstr("there is no view 99"));
}

TEST_F(ControlInterface, SignalsWhatChangedAndNothingElse) {
  auto listener = appliance::openBus(bus_.address());
  ASSERT_TRUE(listener.has_value()) << listener.error();
  std::vector<std::string> signalled;
  const auto on_change = [](sd_bus_message* signal, void* names, sd_bus_error*) {
    const char* interface = nullptr;
    (void)sd_bus_message_read(signal, "s", &interface);
    (void)sd_bus_message_enter_container(signal, 'a', "{sv}");
    while (sd_bus_message_enter_container(signal, 'e', "sv") > 0) {
      const char* name = nullptr;
      (void)sd_bus_message_read(signal, "s", &name);
      static_cast<std::vector<std::string>*>(names)->emplace_back(name);
      (void)sd_bus_message_skip(signal, "v");
      (void)sd_bus_message_exit_container(signal);
    }
    return 0;
  };
  ASSERT_GE(sd_bus_match_signal(listener->get(), nullptr, kName, "/org/kagami/Kagami1",
                                "org.freedesktop.DBus.Properties", "PropertiesChanged", on_change,
                                &signalled),
            0);
  ASSERT_TRUE(client().setTarget({1, 2, 0.5}).has_value());  // it moves with every picture
  ControlClient holder = client();
  ASSERT_TRUE(holder.releaseScreen().has_value());
  for (int i = 0; i < 100 && signalled.empty(); ++i) {
    while (sd_bus_process(listener->get(), nullptr) > 0) {
    }
    (void)sd_bus_wait(listener->get(), 100'000);
  }
  EXPECT_THAT(signalled, ElementsAre("Screen"));
}

TEST_F(ControlInterface, ATextThatIsNotUtf8BreaksNothing) {
  box_.degrade("sensor: \xff\xc3 says its driver");
  const std::string busctl = "busctl --address='" + bus_.address() + "' ";
  EXPECT_TRUE(test::becomesTrue([&] {
    return test::outputOf(busctl +
                          "get-property org.kagami.Kagami1 /org/kagami/Kagami1 "
                          "org.kagami.Kagami1 Degraded")
               .find("sensor: ?? says its driver") != std::string::npos;
  }));
  EXPECT_THAT(
      test::outputOf(busctl + "call org.kagami.Kagami1 /org/kagami/Kagami1 "
                              "org.freedesktop.DBus.Properties GetAll s org.kagami.Kagami1"),
      HasSubstr("\"Degraded\""));
  EXPECT_THAT(client().status().value(), HasSubstr("says its driver"));
}

TEST_F(ControlInterface, TheScreenComesBackWhenThePeerThatHeldItIsGone) {
  {
    ControlClient holder = client();
    ControlClient second = client();
    ASSERT_TRUE(holder.releaseScreen().has_value());
    ASSERT_TRUE(second.releaseScreen().has_value());
    EXPECT_EQ(box_.status().screen, hal::ScreenState::kReleased);
  }
  EXPECT_TRUE(
      test::becomesTrue([&] { return box_.status().screen == hal::ScreenState::kShowing; }));
}

TEST_F(ControlInterface, AJobIsAnObjectThatCanBeReadAndCancelled) {
  daemon_.reset();  // the registry is this thread's until the next one runs
  auto work = appliance::JobThread::start(
      [](appliance::JobThread::Progress& progress, const std::stop_token& stop) {
        progress.set(0.5);
        while (!stop.stop_requested()) std::this_thread::yield();
        return std::expected<std::string, std::string>("seen the half");
      });
  ASSERT_TRUE(work.has_value()) << textOf(work.error());
  ASSERT_TRUE(jobs_.start({.kind = "check", .owner = "", .work = std::move(*work)}).has_value());
  daemon_.emplace(bus_.address(), box_, jobs_);
  ASSERT_TRUE(daemon_->waitUntilConnected()) << daemon_->trouble();

  const std::string busctl = "busctl --address='" + bus_.address() + "' ";
  const std::string job = " org.kagami.Kagami1 /org/kagami/Kagami1/jobs/1 org.kagami.Kagami1.Job ";
  const auto get = [&](const std::string& name) {
    return test::outputOf(busctl + "get-property" + job + name);
  };
  EXPECT_EQ(get("Kind"), "s \"check\"\n");
  EXPECT_TRUE(test::becomesTrue([&] { return get("Progress") == "d 0.5\n"; }));
  EXPECT_EQ(get("State"), "s \"running\"\n");
  EXPECT_THAT(test::outputOf(busctl + "tree org.kagami.Kagami1"),
              HasSubstr("/org/kagami/Kagami1/jobs/1"));
  EXPECT_EQ(test::outputOf(busctl + "call" + job + "Cancel"), "");
  EXPECT_TRUE(test::becomesTrue([&] { return get("State") == "s \"cancelled\"\n"; }));
  EXPECT_EQ(get("Result"), "s \"seen the half\"\n");
  EXPECT_THAT(test::outputOf(busctl + "get-property org.kagami.Kagami1 "
                                      "/org/kagami/Kagami1/jobs/2 org.kagami.Kagami1.Job State"),
              HasSubstr("Unknown object"));
}

TEST_F(ControlInterface, ASecondDaemonOnTheSameBusIsToldSo) {
  Box box;
  appliance::JobRegistry jobs;
  const Daemon second(bus_.address(), box, jobs);
  ASSERT_TRUE(second.waitForTrouble());
  EXPECT_THAT(second.trouble(), HasSubstr("is another kagamid running?"));
}

TEST_F(ControlInterface, IsThereAgainAfterTheBusWasGone) {
  ControlClient holder = client();
  ASSERT_TRUE(holder.releaseScreen().has_value());
  const std::string address = bus_.address();
  bus_.stop();
  ASSERT_TRUE(daemon_->waitForTrouble());
  EXPECT_THAT(daemon_->trouble(), HasSubstr("no control interface, lost the bus"));
  EXPECT_EQ(box_.status().screen, hal::ScreenState::kShowing) << "its holder is gone, too";

  const test::PrivateBus again(address);
  ASSERT_TRUE(daemon_->waitUntilConnected()) << daemon_->trouble();
  EXPECT_TRUE(client().status().has_value());
}

TEST(ControlBus, AnUnreachableBusIsAnOutcome) {
  Box box;
  appliance::JobRegistry jobs;
  const Daemon daemon("unix:path=/nonexistent/bus", box, jobs);
  ASSERT_TRUE(daemon.waitForTrouble());
  EXPECT_THAT(daemon.trouble(), HasSubstr("cannot reach the bus unix:path=/nonexistent/bus"));
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
