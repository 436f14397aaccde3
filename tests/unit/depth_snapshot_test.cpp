// A snapshot of the depth board is a folder that plays as a sensor, or no folder at all.

#include "appliance/depth/depth_snapshot.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "hal/openni/folder_recording.h"
#include "tests/support/becomes_true.h"
#include "tests/support/depth_lender.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using appliance::DepthBoard;
using appliance::RisingNumbers;
using hal::openni::FolderRecording;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class DepthSnapshot : public testing::Test {
 protected:
  void publish(std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t number = from; number <= to; ++number) board_.publish(sensor_.lend(number));
  }
  std::expected<std::string, std::string> write(std::uint32_t pairs,
                                                rt::Nanoseconds patience = 20s) {
    return appliance::writeDepthSnapshot(
        reader_, {.folder = folder_, .sensor = "a sensor", .pairs = pairs, .patience = patience},
        [this](double progress) { progress_.push_back(progress); }, stop_.get_token());
  }
  /// The numbers of the snapshot's pictures.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const {
    const auto recording = FolderRecording::open(folder_);
    if (!recording) {
      ADD_FAILURE() << recording.error();
      return {};
    }
    EXPECT_EQ(recording->name(), "a sensor");
    EXPECT_TRUE(recording->colour());
    std::vector<std::uint64_t> all;
    for (const auto& entry : recording->entries()) {
      all.push_back(entry.number);
      const auto pictures = recording->read(entry);
      EXPECT_TRUE(pictures.has_value());
      if (!pictures) continue;
      EXPECT_EQ(pictures->depth_mm[0], entry.number);
    }
    return all;
  }

  test::TemporaryFolder scratch_;
  const fs::path folder_ = scratch_ / "snapshot";
  test::DepthLender sensor_{64, 48};
  DepthBoard board_;
  appliance::DepthReader& reader_ = **board_.openReader("snapshot", appliance::kSnapshotPins);
  std::stop_source stop_;
  std::vector<double> progress_;
};

TEST_F(DepthSnapshot, HoldsTheNewestPairsThatTheBoardKeeps) {
  publish(1, 20);
  EXPECT_EQ(write(4), folder_.string());
  EXPECT_THAT(numbers(), ElementsAre(17, 18, 19, 20));
  EXPECT_THAT(progress_, ElementsAre(0.25, 0.5, 0.75, 1));
  EXPECT_EQ(reader_.status().lost, 0u) << "what came before was not asked for";
  EXPECT_EQ(reader_.status().pinned, 0u);
}

TEST_F(DepthSnapshot, GoesOnWithThePairsThatCome) {
  publish(1, 3);
  std::jthread later([&] {
    ASSERT_TRUE(test::becomesTrue([&] { return reader_.status().taken == 3; }));
    publish(4, 6);
  });
  EXPECT_TRUE(write(6).has_value());
  EXPECT_THAT(numbers(), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(DepthSnapshot, TheNextOneBeginsWithTheNewestAgain) {
  publish(1, 10);
  ASSERT_TRUE(write(2).has_value());
  fs::remove_all(folder_);
  ASSERT_TRUE(write(3).has_value());
  EXPECT_THAT(numbers(), ElementsAre(8, 9, 10));
}

TEST_F(DepthSnapshot, LeavesNothingIfItIsCancelled) {
  publish(1, 2);
  std::jthread later([&] {
    const auto both_written = [&] {
      const auto reader = reader_.status();
      return reader.taken == 2 && reader.pinned == 0;
    };
    ASSERT_TRUE(test::becomesTrue(both_written));
    stop_.request_stop();
  });
  const auto ended = write(100);
  EXPECT_EQ(ended, "cancelled after 2 of 100 pairs: nothing was kept");
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(DepthSnapshot, EndsIfNoPictureComesAndLeavesNothing) {
  publish(1, 2);
  const auto ended = write(3, 10ms);
  ASSERT_FALSE(ended.has_value());
  EXPECT_THAT(ended.error(), HasSubstr("no picture came from the depth sensor after 2 of 3 pairs"));
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(DepthSnapshot, SaysThatItsFolderCannotBeWritten) {
  publish(1, 1);
  std::ofstream(scratch_ / "file") << "in the way";
  const auto ended = appliance::writeDepthSnapshot(
      reader_, {.folder = scratch_ / "file" / "snapshot", .sensor = "a sensor"}, [](double) {}, {});
  ASSERT_FALSE(ended.has_value());
  EXPECT_THAT(ended.error(),
              testing::AllOf(StartsWith((scratch_ / "file").string()),
                             HasSubstr("cannot be written"), HasSubstr("give a folder")));
}

TEST_F(DepthSnapshot, SaysThatTheDiskIsFullAndLeavesNothing) {
  publish(1, 1);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit before = limit;
  limit.rlim_cur = 100;  // bytes of a file
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto ended = write(1);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(ended.has_value());
  EXPECT_THAT(ended.error(), HasSubstr("make room on its disk"));
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(DepthSnapshot, EndsIfThePicturesChangeTheirSize) {
  publish(1, 1);
  test::DepthLender larger(80, 60);
  board_.publish(larger.lend(2));
  const auto ended = write(2);
  ASSERT_FALSE(ended.has_value());
  EXPECT_THAT(ended.error(), HasSubstr("changed from 64x48 to 80x60 after 1 of 2 pairs"));
  EXPECT_FALSE(fs::exists(folder_));
}

TEST(RisingNumbers, KeepGapsAndGoOnIfTheSensorCountsFromTheBeginningAgain) {
  RisingNumbers numbers;
  std::vector<std::uint64_t> of;
  for (const std::uint64_t sensors : {7, 8, 10, 1, 2, 2, 4}) of.push_back(numbers.of(sensors));
  EXPECT_THAT(of, ElementsAre(7, 8, 10, 11, 12, 13, 15));
}

TEST(SnapshotFolder, IsNotThereYet) {
  const test::TemporaryFolder scratch;
  const fs::path first = appliance::snapshotFolder(scratch.path());
  EXPECT_THAT(first.filename().string(), StartsWith("snapshot-20"));
  fs::create_directories(first);
  const fs::path second = appliance::snapshotFolder(scratch.path());
  EXPECT_FALSE(fs::exists(second));
}

}  // namespace
