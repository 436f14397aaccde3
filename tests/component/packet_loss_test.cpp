// Lost packets on the real programs: twenty emulated cameras whose wire loses one packet of a
// hundred, resent ones too, and one whose path lets no large packet through.

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kAddress = "127.0.12.1";
constexpr const char* kFaultPort = "4013";

/// kagamid on @p cameras small cameras; everything that both programs wrote.
struct BoxRun {
  BoxRun(std::uint32_t cameras, const std::string& fault, const std::vector<std::string>& settings,
         std::chrono::seconds length) {
    const std::vector<std::string> far{
        KAGAMI_EMULATOR,   "--cameras", std::to_string(cameras), "--size",  "320x240",
        "--first-address", kAddress,    "--wire-port",           "4012",    "--fault-port",
        kFaultPort,        "--rig-out", folder / "rig.toml",     "--stats", folder / "stats.json"};
    test::ChildProcess emulator(far, folder / "emulator.log");
    if (!emulator.waitForOutput("ready", 60s)) {
      ADD_FAILURE() << emulator.output();
      return;
    }
    test::ChildProcess command(
        {KAGAMI_EMULATOR, "--first-address", kAddress, "--fault-port", kFaultPort, "fault", fault},
        folder / "fault.log");
    EXPECT_EQ(command.wait(20s), 0) << command.output();
    std::string addresses;
    for (std::uint32_t i = 1; i <= cameras; ++i) {
      addresses += (i > 1 ? ",\"127.0.12." : "\"127.0.12.") + std::to_string(i) + "\"";
    }
    std::vector<std::string> near{KAGAMID, "--config", KAGAMID_CONFIG};
    const auto set = [&](const std::string& setting) {
      near.emplace_back("--set");
      near.push_back(setting);
    };
    set("rig.file=" + (folder / "rig.toml").string());
    set("cameras.addresses=[" + addresses + "]");
    set("cameras.packet_size_bytes=1500");
    set("trigger.wire_port=4012");
    set("trigger.rate_hz=4");
    // A busy machine answers late, and no frame may be given up for that.
    set("resend.frame_retention_us=1000000");
    set("history.sets=40");
    set("display.refresh_hz=8");
    set("state.trace=" + (folder / "trace.jsonl").string());
    set("control.bus=none");
    for (const std::string& setting : settings) set(setting);
    test::ChildProcess daemon(near, folder / "kagamid.log");
    if (!daemon.waitForOutput("running:", 120s)) {
      ADD_FAILURE() << daemon.output();
      return;
    }
    std::this_thread::sleep_for(length);
    daemon.terminate();
    EXPECT_EQ(daemon.wait(60s), 0);
    said = daemon.output();
    emulator.terminate();
    EXPECT_EQ(emulator.wait(20s), 0) << emulator.output();
    std::ifstream trace(folder / "trace.jsonl");
    for (std::string line; std::getline(trace, line);) {
      json record = json::parse(line);
      records[record["record"]].push_back(std::move(record));
    }
    std::ifstream(folder / "stats.json") >> stats;
  }

  test::TemporaryFolder folder;
  std::string said;
  std::map<std::string, std::vector<json>> records;
  json stats;
};

TEST(PacketLoss, OfOnePercentLeavesNoFrameOfTwentyCamerasIncomplete) {
  const BoxRun run(20, "all loss 1", {}, 6s);
  ASSERT_FALSE(run.records.empty());
  EXPECT_GT(run.stats["packets_lost_on_purpose"], 50);
  EXPECT_GT(run.stats["packets_resent"], 50);
  const json& summary = run.records.at("summary").front();
  EXPECT_EQ(summary["frames_incomplete"], 0);
  EXPECT_EQ(summary["frames_unattributed"], 0);
  std::size_t stored = 0;
  for (const json& frame : run.records.at("frame")) stored += frame["trigger"] != 0 ? 1 : 0;
  EXPECT_EQ(stored, run.records.at("trigger").size() * 20);
}

TEST(PacketSize, ThatDoesNotArriveIsMadeSmallerAndSaid) {
  const BoxRun run(1, "1 mtu 1500", {"cameras.packet_size_bytes=9000"}, 3s);
  ASSERT_FALSE(run.records.empty());
  EXPECT_THAT(run.said, HasSubstr("packets of 9000 bytes do not arrive: 1500 used; raise the MTU"));
  EXPECT_EQ(run.records.at("summary").front()["frames_incomplete"], 0);
  EXPECT_GT(run.records.at("frame").size(), 3U);
}

}  // namespace
