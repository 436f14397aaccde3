// What a maintainer types: kagami speaks over a bus with the running kagamid, which shows what
// emulated cameras send.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/component/private_bus.h"
#include "tests/support/child_process.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class CommandLine : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty()) GTEST_SKIP() << "dbus-daemon is not installed";
    ASSERT_TRUE(emulator_.waitForOutput("ready", 30s)) << emulator_.output();
    daemon_ = std::make_unique<test::ChildProcess>(
        std::vector<std::string>{KAGAMID, "--config", KAGAMID_CONFIG,                        //
                                 "--set", "rig.file=" + (folder_ / "rig.toml").string(),     //
                                 "--set", R"(cameras.addresses=["127.0.5.1","127.0.5.2"])",  //
                                 "--set", "cameras.packet_size_bytes=1500",                  //
                                 "--set", "trigger.wire_port=3995",                          //
                                 "--set", "trigger.rate_hz=10",                              //
                                 "--set", "history.sets=40",                                 //
                                 "--set", "display.refresh_hz=20",                           //
                                 "--set", "control.bus=" + bus_.address()},
        folder_ / "kagamid.log");
    ASSERT_TRUE(daemon_->waitForOutput("running:", 60s)) << daemon_->output();
  }

  void TearDown() override {
    if (!daemon_) return;
    daemon_->terminate();
    EXPECT_EQ(daemon_->wait(60s), 0) << daemon_->output();
  }

  struct Answer {
    int exit_status;
    std::string text;
  };

  Answer kagami(std::vector<std::string> words) {
    words.insert(words.begin(), {KAGAMI, "--bus", bus_.address()});
    test::ChildProcess program(words, folder_ / "kagami.log");
    const int status = program.wait(20s).value_or(-1);
    return {status, program.output()};
  }

  /// Whether the daemon comes to be as @p wanted says, within a generous time.
  testing::AssertionResult becomes(const std::function<bool(const json&)>& wanted) {
    std::string last;
    for (int i = 0; i < 100; ++i) {
      const Answer answer = kagami({"status", "--json"});
      last = answer.text;
      if (answer.exit_status == 0 && wanted(json::parse(answer.text))) {
        return testing::AssertionSuccess();
      }
      std::this_thread::sleep_for(100ms);
    }
    return testing::AssertionFailure() << last;
  }

  test::TemporaryFolder folder_;
  PrivateBus bus_;
  test::ChildProcess emulator_{
      {KAGAMI_EMULATOR, "--cameras", "2", "--size", "448x320", "--first-address", "127.0.5.1",
       "--wire-port", "3995", "--rig-out", (folder_ / "rig.toml").string()},
      folder_ / "emulator.log"};
  std::unique_ptr<test::ChildProcess> daemon_;
};

TEST_F(CommandLine, LeadsTheBoxThroughItsModes) {
  ASSERT_TRUE(becomes([](const json& status) {
    return status["mode"] == "live" && status["shown_hz"] > 0 && status["history_ms"] > 1500;
  }));
  EXPECT_EQ(kagami({"delay", "1"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) {
    return status["mode"] == "delayed" && status["delay_ms"] == 1000;
  }));
  EXPECT_EQ(kagami({"freeze"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) { return status["mode"] == "frozen"; }));
  EXPECT_EQ(kagami({"view", "2"}).exit_status, 0);
  EXPECT_TRUE(becomes(
      [](const json& status) { return status["mode"] == "frozen" && status["view_shown"] == 2; }));
  EXPECT_EQ(kagami({"target", "0.1", "0.2", "1.1"}).exit_status, 0);
  EXPECT_TRUE(becomes(
      [](const json& status) { return status["target_m"] == json::array({0.1, 0.2, 1.1}); }));
  EXPECT_EQ(kagami({"mode", "live"}).exit_status, 0);
  EXPECT_TRUE(becomes([](const json& status) { return status["mode"] == "live"; }));
}

TEST_F(CommandLine, RefusesWhatIsNotThereInOneLineAndStaysAsItWas) {
  ASSERT_TRUE(becomes([](const json& status) { return status["shown_hz"] > 0; }));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"view", "3"}, {"delay", "-1"}, {"mode", "backwards"}}) {
    const Answer answer = kagami(words);
    EXPECT_NE(answer.exit_status, 0) << words.front();
    EXPECT_FALSE(answer.text.empty()) << words.front();
  }
  EXPECT_TRUE(becomes(
      [](const json& status) { return status["mode"] == "live" && status["view_wanted"] == 1; }));
}

TEST_F(CommandLine, TellsTheStateInWordsToo) {
  const Answer answer = kagami({"status"});
  EXPECT_EQ(answer.exit_status, 0);
  EXPECT_NE(answer.text.find("live"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("view     1 of 2"), std::string::npos) << answer.text;
}

}  // namespace
