// Lost packets on the real programs: twenty emulated cameras whose wire loses one packet of a
// hundred, resent ones too, and one whose path lets no large packet through.

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kAddress = "127.0.12.1";
constexpr const char* kFaultPort = "4013";

/// kagamid on @p cameras small cameras; everything that both programs wrote.
struct BoxRun {
  BoxRun(int cameras, const std::string& fault, std::vector<std::string> settings,
         std::chrono::seconds length) {
    const test::CameraNetwork network{
        .first_address = kAddress, .cameras = cameras, .wire_port = 4012};
    test::ChildProcess emulator(
        emulatorCommand(network, "320x240", folder.path(),
                        {"--fault-port", kFaultPort, "--stats", folder / "stats.json"}),
        folder / "emulator.log");
    if (!emulator.waitForOutput("ready", 60s)) {
      ADD_FAILURE() << emulator.output();
      return;
    }
    test::ChildProcess command(
        {KAGAMI_EMULATOR, "--first-address", kAddress, "--fault-port", kFaultPort, "fault", fault},
        folder / "fault.log");
    EXPECT_EQ(command.wait(20s), 0) << command.output();
    settings.insert(settings.begin(),
                    {"trigger.rate_hz=4",
                     // A busy machine answers late, and no frame may be given up for that.
                     "resend.frame_retention_us=1000000", "display.refresh_hz=8",
                     "state.trace=" + (folder / "trace.jsonl").string()});
    test::ChildProcess daemon(kagamidCommand(network, folder.path(), settings),
                              folder / "kagamid.log");
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
    records = test::readTrace(folder / "trace.jsonl");
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
