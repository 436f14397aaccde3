// kagamid on its wires: trigger, loop-back and panel are lines of real GPIO chips, the cameras
// emulated ones behind the bridge.

#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/kernel/support/gpio_sim.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trace_records.h"

namespace test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class WiredDaemon : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* button : {"button-live", "button-freeze"}) panel_.pull(button, true);
  }

  void TearDown() override {
    if (!bridge_) return;
    bridge_->terminate();  // it removes its recorder
    (void)bridge_->wait(20s);
  }

  /// Starts bridge, cameras and daemon; until it runs.
  void start(const std::vector<std::string>& more = {}, bool loopback_wire = true) {
    std::vector<std::string> bridge = {TRIGGER_BRIDGE, "TRIGGER", "3990"};
    if (loopback_wire) bridge.insert(bridge.end(), {"--loop-back", board_.lineFolder("BACK")});
    bridge_.emplace(bridge, folder_ / "bridge.log");
    ASSERT_TRUE(bridge_->waitForOutput("ready", 60s)) << bridge_->output();
    startDaemon(more);
    ASSERT_TRUE(daemon_->waitForOutput("running:", 120s)) << daemon_->output();
  }

  /// Cameras and daemon alone, without waiting for it.
  void startDaemon(const std::vector<std::string>& more) {
    emulator_.emplace(std::vector<std::string>{KAGAMI_EMULATOR, "--cameras", "2", "--size",
                                               "320x256", "--rig-out", path("rig.toml")},
                      folder_ / "emulator.log");
    ASSERT_TRUE(emulator_->waitForOutput("ready", 60s)) << emulator_->output();
    std::vector<std::string> daemon = {KAGAMID, "--config", KAGAMID_CONFIG};
    for (const std::string& setting :
         {"rig.file=" + path("rig.toml"),
          std::string(R"(cameras.addresses=["127.0.0.1","127.0.0.2"])"),
          std::string("cameras.packet_size_bytes=1500"), std::string("trigger.backend=gpiod"),
          std::string(R"(trigger.lines=["TRIGGER"])"), std::string("trigger.loopback_line=BACK"),
          std::string("trigger.rate_hz=10"), std::string("history.sets=20"),
          std::string("display.width_px=320"), std::string("display.height_px=180"),
          std::string("display.refresh_hz=20"), std::string("panel.backend=gpiod"),
          "state.trace=" + path("trace.jsonl"), std::string("control.bus=none")})
      daemon.insert(daemon.end(), {"--set", setting});
    for (const std::string& setting : more) daemon.insert(daemon.end(), {"--set", setting});
    daemon_.emplace(daemon, folder_ / "kagamid.log");
  }

  /// Ends the daemon; its trace by kinds of record.
  std::map<std::string, std::vector<json>> stop() {
    daemon_->terminate();
    EXPECT_EQ(daemon_->wait(60s), 0) << daemon_->output();
    return test::readTrace(folder_ / "trace.jsonl");
  }

  /// Whether a lamp is lit within a generous time.
  [[nodiscard]] bool waitLit(const std::string& mode) const {
    for (int i = 0; i < 200; ++i) {
      if (panel_.level("lamp-" + mode)) return true;
      std::this_thread::sleep_for(20ms);
    }
    return false;
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  TemporaryFolder folder_;
  GpioSim board_{"board", {"SPARE", "TRIGGER", "BACK"}};
  GpioSim panel_{"panel",
                 {"button-live", "button-freeze", "lamp-live", "lamp-delayed", "lamp-frozen"}};
  std::optional<ChildProcess> bridge_;
  std::optional<ChildProcess> emulator_;
  std::optional<ChildProcess> daemon_;
};

TEST_F(WiredDaemon, MeasuresItsEdgesAndLightsTheLampOfTheMode) {
  start();
  if (HasFatalFailure()) return;
  EXPECT_TRUE(waitLit("live"));
  std::this_thread::sleep_for(2s);
  panel_.pull("button-freeze", false);
  EXPECT_TRUE(waitLit("frozen"));
  EXPECT_FALSE(panel_.level("lamp-live"));
  panel_.pull("button-freeze", true);
  std::this_thread::sleep_for(500ms);
  panel_.pull("button-live", false);
  EXPECT_TRUE(waitLit("live"));
  panel_.pull("button-live", true);
  std::this_thread::sleep_for(500ms);

  auto records = stop();
  EXPECT_FALSE(board_.level("TRIGGER"));
  EXPECT_FALSE(panel_.level("lamp-live"));
  EXPECT_THAT(daemon_->output(), Not(HasSubstr("loop-back")));
  std::map<std::uint64_t, std::int64_t> edges;
  for (const json& trigger : records["trigger"])
    edges[trigger["trigger"]] = trigger["trigger_edge_before_ns"];
  ASSERT_GT(edges.size(), 20U);
  // Each edge comes back through the bridge, which looks twice in a millisecond.
  EXPECT_GE(records["loopback"].size() + 1, edges.size());
  for (const json& seen : records["loopback"]) {
    ASSERT_TRUE(edges.contains(seen["trigger"])) << seen;
    const std::int64_t delay_ns = seen["edge_ns"].get<std::int64_t>() - edges[seen["trigger"]];
    EXPECT_GE(delay_ns, 0);
    EXPECT_LE(delay_ns, 5'000'000);
  }
  EXPECT_EQ(records["summary"].front()["frames_unattributed"], 0);
}

TEST_F(WiredDaemon, TellsOnceThatItsPanelWasUnplugged) {
  start();
  if (HasFatalFailure()) return;
  panel_.remove();
  ASSERT_TRUE(daemon_->waitForOutput("the panel's GPIO chip has disappeared", 60s))
      << daemon_->output();
  std::this_thread::sleep_for(1s);
  const std::string output = daemon_->output();
  EXPECT_EQ(output.find("GPIO chip has disappeared"), output.rfind("GPIO chip has disappeared"));
  EXPECT_GT(stop()["frame"].size(), 10U);
}

TEST_F(WiredDaemon, RunsOnWithWrongPolarityAndSaysSo) {
  start({"trigger.loopback_active_low=true"});
  if (HasFatalFailure()) return;
  std::this_thread::sleep_for(1s);
  EXPECT_THAT(daemon_->output(), HasSubstr("trigger polarity wrong"));
  auto records = stop();
  EXPECT_GT(records["frame"].size(), 10U);
  EXPECT_TRUE(records["loopback"].empty());
}

TEST_F(WiredDaemon, RunsOnWithoutLoopbackWireAndPanel) {
  start({"panel.button_prefix=key-"}, false);
  if (HasFatalFailure()) return;
  std::this_thread::sleep_for(1s);
  EXPECT_THAT(daemon_->output(), HasSubstr("no edge came back"));
  EXPECT_THAT(daemon_->output(), HasSubstr("no GPIO line is named \"key-live\""));
  EXPECT_THAT(daemon_->output(), HasSubstr("the box runs without its panel"));
  EXPECT_GT(stop()["frame"].size(), 10U);
}

TEST_F(WiredDaemon, EndsWithOneLineWhenItsTriggerLineIsMissing) {
  startDaemon({R"(trigger.lines=["TRIGER"])"});
  if (HasFatalFailure()) return;
  EXPECT_EQ(daemon_->wait(120s), 1);
  EXPECT_THAT(daemon_->output(), HasSubstr("no GPIO line is named \"TRIGER\"; the nearest"));
}

}  // namespace
}  // namespace test
