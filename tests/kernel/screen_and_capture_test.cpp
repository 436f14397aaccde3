// What happens to the screen is no concern of the cameras: a whole daemon whose screen is pulled
// and given away, and that loses no frame meanwhile.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <xf86drm.h>

#include "appliance/control/control_client.h"
#include "rt/unique_fd.h"
#include "tests/support/child_process.h"
#include "tests/support/private_bus.h"

namespace test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr int kTimes = 20;
const std::string kCard = "/dev/dri/card0";
const char* const kPulled = "/run/cable-is-pulled";

class ScreenAndCapture : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(bus_.address().empty()) << "dbus-daemon is not installed";
    emulator_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{KAGAMI_EMULATOR, "--cameras", "4", "--size", "320x256",
                                 "--rig-out", "rig.toml"},
        "emulator.log");
    ASSERT_TRUE(emulator_->waitForOutput("ready", 60s)) << emulator_->output();
    std::vector<std::string> command{KAGAMID, "--config", KAGAMID_CONFIG};
    for (const std::string& setting :
         {std::string("rig.file=rig.toml"),
          std::string(R"(cameras.addresses=["127.0.0.1","127.0.0.2","127.0.0.3","127.0.0.4"])"),
          std::string("trigger.rate_hz=10"), std::string("history.sets=30"),
          std::string("display.backend=kms"), "display.device=" + kCard,
          std::string("display.mode=640x480"), "control.bus=" + bus_.address()}) {
      command.insert(command.end(), {"--set", setting});
    }
    ::setenv("LD_PRELOAD", PULLED_CABLE_LIBRARY, 1);
    ::setenv("PULLED_CABLE", kPulled, 1);
    daemon_ = std::make_unique<ChildProcess>(command, "kagamid.log");
    ::unsetenv("LD_PRELOAD");
    ASSERT_TRUE(daemon_->waitForOutput("running:", 120s)) << daemon_->output();
    auto kagami = appliance::ControlClient::open(bus_.address(), "org.kagami.Kagami1");
    ASSERT_TRUE(kagami) << kagami.error();
    kagami_.emplace(std::move(*kagami));
    ASSERT_TRUE(waitForScreen("showing")) << daemon_->output();
  }

  // By the library, not the program: starting a process is dear in this kernel.
  [[nodiscard]] json status() {
    const auto answer = kagami_->status();
    return answer ? json::parse(*answer, nullptr, false) : json(json::value_t::discarded);
  }
  [[nodiscard]] bool waitForScreen(const std::string& state) {
    for (int i = 0; i < 200; ++i) {
      const json now = status();
      if (!now.is_discarded() && now["screen"]["state"] == state) return true;
      std::this_thread::sleep_for(50ms);
    }
    return false;
  }
  void expectNoFrameLost(std::uint64_t triggers_before) {
    const json now = status();
    EXPECT_GT(now["triggers"].get<std::uint64_t>(), triggers_before);
    EXPECT_EQ(now["frames_lost"], 0);
    EXPECT_EQ(now["frames_incomplete"], 0);
    for (const json& camera : now["cameras"]) EXPECT_EQ(camera["state"], "streaming");
    daemon_->terminate();
    EXPECT_EQ(daemon_->wait(60s), 0) << daemon_->output();
  }

  test::PrivateBus bus_;
  std::unique_ptr<ChildProcess> emulator_;
  std::unique_ptr<ChildProcess> daemon_;
  std::optional<appliance::ControlClient> kagami_;
};

TEST_F(ScreenAndCapture, TwentyUnplugsLoseNoFrame) {
  const auto before = status()["triggers"].get<std::uint64_t>();
  for (int time = 0; time < kTimes; ++time) {
    std::ofstream(kPulled) << "pulled";
    ASSERT_TRUE(waitForScreen("no screen")) << "after " << time;
    std::filesystem::remove(kPulled);
    ASSERT_TRUE(waitForScreen("showing")) << "after " << time;
  }
  expectNoFrameLost(before);
}

TEST_F(ScreenAndCapture, TwentyHandOversLoseNoFrame) {
  const auto before = status()["triggers"].get<std::uint64_t>();
  const rt::UniqueFd other(::open(kCard.c_str(), O_RDWR | O_CLOEXEC));
  for (int time = 0; time < kTimes; ++time) {
    ASSERT_NE(drmSetMaster(other.get()), 0) << "the daemon holds the screen";
    ASSERT_TRUE(kagami_->releaseScreen());
    ASSERT_TRUE(waitForScreen("released")) << "after " << time;
    ASSERT_EQ(drmSetMaster(other.get()), 0) << "after " << time;
    drmDropMaster(other.get());
    ASSERT_TRUE(kagami_->takeScreen());
    ASSERT_TRUE(waitForScreen("showing")) << "after " << time;
  }
  expectNoFrameLost(before);
}

}  // namespace
}  // namespace test
