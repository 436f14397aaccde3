// `kagami depth snapshot` against a box with a depth sensor, over the real bus.

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/control/control_client.h"
#include "appliance/depth/depth_part.h"
#include "hal/backends.h"
#include "hal/openni/folder_recording.h"
#include "tests/support/becomes_true.h"
#include "tests/support/child_process.h"
#include "tests/support/depth_lender.h"
#include "tests/support/interface_members.h"
#include "tests/support/no_display.h"
#include "tests/support/output_of.h"
#include "tests/support/private_bus.h"
#include "tests/support/served_box.h"
#include "tests/support/small_site.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using appliance::Box;
using hal::openni::FolderRecording;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class DepthSnapshotCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty())
      GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
    test::DepthLender sensor(64, 48);
    const auto recorder = hal::makeDepthRecorder(recording_);
    for (std::uint64_t number = 1; number <= 10; ++number) {
      hal::DepthFrame frame = sensor.lend(number);
      frame.exposure = rt::fromNs(static_cast<std::int64_t>(number) * 20'000'000);
      const auto written = recorder->write(frame, "a sensor");
      ASSERT_TRUE(written.has_value()) << written.error();
    }
  }
  void TearDown() override {
    served_.reset();
    if (!box_) return;
    EXPECT_TRUE(box_->stop().has_value());
  }

  void startBox(const std::string& backend) {
    appliance::Site site = test::smallSite();
    site.config.depth_sensor.backend = backend;
    site.config.depth_sensor.device.source = recording_;
    site.config.state.directory = state_;
    static constexpr std::array<appliance::PartEntry, 1> kParts = {{{appliance::makeDepthPart}}};
    auto box = Box::start(site, {.display = display_, .parts = kParts});
    ASSERT_TRUE(box.has_value()) << box.error();
    box_ = std::move(*box);
    served_ = std::make_unique<test::ServedBox>(*box_, bus_.address());
    auto client = appliance::ControlClient::open(bus_.address(), "org.kagami.Kagami1");
    ASSERT_TRUE(client.has_value()) << client.error();
    ASSERT_TRUE(test::becomesTrue([&] { return client->status().has_value(); }));
  }

  [[nodiscard]] std::unique_ptr<test::ChildProcess> snapshot(std::vector<std::string> words) {
    words.insert(words.begin(), {KAGAMI, "--bus", bus_.address(), "depth", "snapshot"});
    const std::string log = "kagami-" + std::to_string(++commands_) + ".log";
    return std::make_unique<test::ChildProcess>(words, scratch_ / log, test::ProcessGroup::kOwn);
  }
  /// The folders of snapshots that the box wrote.
  [[nodiscard]] std::vector<fs::path> kept() const {
    std::error_code none;
    std::vector<fs::path> all;
    for (const auto& folder : fs::directory_iterator(state_ / "depth", none))
      all.push_back(folder.path());
    return all;
  }

  test::TemporaryFolder scratch_;
  const fs::path recording_ = scratch_ / "recording";
  fs::path state_ = scratch_ / "state";
  test::PrivateBus bus_;
  int commands_ = 0;
  test::NoDisplay display_;
  std::unique_ptr<Box> box_;
  std::unique_ptr<test::ServedBox> served_;
};

TEST_F(DepthSnapshotCommand, WritesAFolderThatPlaysAsASensorIntoTheBoxsStateDirectory) {
  startBox("folder");
  const auto command = snapshot({"--frames", "12"});
  ASSERT_EQ(command->wait(60s), 0) << command->output();
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_EQ(command->output(), kept()[0].string() + ": 12 pairs\n");
  const auto snapshot = FolderRecording::open(kept()[0]);
  ASSERT_TRUE(snapshot.has_value()) << snapshot.error();
  EXPECT_EQ(snapshot->name(), "a sensor");
  EXPECT_TRUE(snapshot->colour());
  EXPECT_EQ(snapshot->entries().size(), 12u);
}

TEST_F(DepthSnapshotCommand, MovesTheFolderToWhereTheCallerWantsIt) {
  startBox("folder");
  const fs::path wanted = scratch_ / "wanted";
  const auto command = snapshot({"--frames", "2", "--out", wanted});
  ASSERT_EQ(command->wait(60s), 0) << command->output();
  EXPECT_EQ(command->output(), wanted.string() + ": 2 pairs\n");
  EXPECT_TRUE(FolderRecording::open(wanted).has_value());
  EXPECT_TRUE(kept().empty());
}

TEST_F(DepthSnapshotCommand, BeginsNothingIfTheCallersFolderCannotBeMade) {
  startBox("folder");
  const auto taken = snapshot({"--out", recording_});
  EXPECT_EQ(taken->wait(60s), 1);
  EXPECT_EQ(taken->output(),
            "kagami: " + recording_.string() + ": exists already: give a new folder\n");
  const auto nowhere = snapshot({"--out", scratch_ / "nowhere" / "snapshot"});
  EXPECT_EQ(nowhere->wait(60s), 1);
  EXPECT_THAT(nowhere->output(), HasSubstr("there is no such folder: make it first"));
  EXPECT_TRUE(kept().empty());
}

TEST_F(DepthSnapshotCommand, CtrlCCancelsItAndNothingIsKept) {
  startBox("folder");
  const auto command = snapshot({"--frames", "900"});
  ASSERT_TRUE(test::becomesTrue([&] { return kept().size() == 1; })) << command->output();
  kill(command->pid(), SIGINT);
  EXPECT_EQ(command->wait(60s), 128 + SIGINT) << command->output();
  EXPECT_THAT(command->output(),
              AllOf(StartsWith("kagami: cancelled after "), HasSubstr("nothing was kept")));
  EXPECT_TRUE(kept().empty());
}

TEST_F(DepthSnapshotCommand, ACallerThatDiesCancelsIt) {
  startBox("folder");
  const auto command = snapshot({"--frames", "900"});
  ASSERT_TRUE(test::becomesTrue([&] { return kept().size() == 1; })) << command->output();
  kill(command->pid(), SIGKILL);
  EXPECT_TRUE(test::becomesTrue([&] { return kept().empty(); }));
}

TEST_F(DepthSnapshotCommand, ASecondOneWaitsForTheFirst) {
  startBox("folder");
  const auto first = snapshot({"--frames", "900"});
  ASSERT_TRUE(test::becomesTrue([&] { return kept().size() == 1; })) << first->output();
  const auto second = snapshot({});
  EXPECT_EQ(second->wait(60s), 1);
  EXPECT_THAT(second->output(), StartsWith("kagami: a snapshot is being written"));
  first->terminate();
  EXPECT_EQ(first->wait(60s), 128 + SIGTERM);
}

TEST_F(DepthSnapshotCommand, ABoxWithoutASensorSaysSo) {
  startBox("none");
  const auto command = snapshot({});
  EXPECT_EQ(command->wait(60s), 1);
  EXPECT_THAT(command->output(), StartsWith("kagami: this box runs without a depth sensor"));
}

TEST_F(DepthSnapshotCommand, SaysThatTheStateDirectoryCannotBeWritten) {
  std::ofstream(scratch_ / "file") << "in the way";
  state_ = scratch_ / "file";
  startBox("folder");
  const auto command = snapshot({});
  EXPECT_EQ(command->wait(60s), 1);
  EXPECT_THAT(command->output(), AllOf(StartsWith("kagami: " + state_.string()),
                                       HasSubstr("cannot be written (Not a directory)")));
}

TEST_F(DepthSnapshotCommand, TheXmlFileSaysWhatTheRunningBoxSays) {
  if (test::outputOf("busctl --version").find("systemd") == std::string::npos)
    GTEST_SKIP() << "busctl is not installed (package systemd)";
  startBox("folder");
  const auto published = test::membersOf(test::contentOf(KAGAMI_DEPTH_INTERFACE));
  EXPECT_EQ(published.size(), 3u);
  const auto seen = test::membersOf(
      test::outputOf("busctl --address='" + bus_.address() +
                     "' --xml-interface introspect org.kagami.Kagami1 /org/kagami/Kagami1/depth"));
  EXPECT_EQ(seen, published);
}

}  // namespace
