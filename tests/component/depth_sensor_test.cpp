// A depth sensor through OpenNI2 and all that may be wrong with it: the emulated driver on one
// side, the interface that the daemon uses on the other.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/openni/folder_sensor.h"
#include "hal/openni/openni_sensor.h"
#include "tests/support/depth_feed.h"
#include "tests/support/depth_recordings.h"
#include "tests/support/temporary_folder.h"

namespace {

using hal::DepthState;
using hal::openni::FolderSensor;
using hal::openni::OpenniSensor;
using hal::openni::Play;
using hal::openni::SensorOptions;
using test::DepthFeed;
using test::TemporaryFolder;
using testing::HasSubstr;
using namespace std::chrono_literals;

hal::DepthSensorSettings live() {
  return {.drivers = KAGAMI_DEPTH_DRIVERS, .width_px = 320, .height_px = 240, .latency = 40ms};
}

std::unique_ptr<OpenniSensor> opened(const hal::DepthSensorSettings& settings,
                                     const SensorOptions& options = {}) {
  auto sensor = OpenniSensor::open(settings, options);
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return nullptr;
  }
  return std::move(*sensor);
}

/// Waits until @p holds; the sensor is used meanwhile, as its only caller does.
template <class Holds>
bool waitUntil(hal::DepthSensor& sensor, const Holds& holds) {
  const rt::Timestamp end = rt::now() + 30s;
  while (rt::now() < end) {
    if (holds()) return true;
    (void)sensor.waitFrame(20ms);
  }
  return false;
}

/// The sensor's message, once it is about @p what.
std::string messageAbout(hal::DepthSensor& sensor, const std::string& what) {
  (void)waitUntil(sensor, [&] { return sensor.status().message.find(what) != std::string::npos; });
  return sensor.status().message;
}

/// The worker processes of this one.
std::vector<pid_t> workers() {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream status(entry.path() / "stat");
    std::string line;
    if (!std::getline(status, line) || line.find("(kagami-depth)") == std::string::npos) continue;
    const std::string rest = line.substr(line.rfind(')') + 4);
    if (std::stol(rest) == ::getpid()) found.push_back(std::stoi(entry.path().filename()));
  }
  return found;
}

TEST(OpenniSensor, SaysWhenTheLightWasTaken) {
  const DepthFeed feed;
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  rt::Nanoseconds least = 1h;  // from exposure to arrival: a busy machine's may exceed the sensor's
  for (int i = 0; i < 60; ++i) {
    const auto frame = sensor->waitFrame(20s);
    ASSERT_TRUE(frame) << sensor->status().message;
    const rt::Timestamp truth = feed.exposureOf(frame->number);
    ASSERT_NE(truth, rt::Timestamp{});
    EXPECT_GE(frame->frame_ready - truth, 40ms);
    least = std::min(least, frame->frame_ready - truth);
    // Arrivals bound what can be known; within that the stamps decide everything.
    const rt::Nanoseconds unknowable = least - 40ms;
    EXPECT_LT(std::chrono::abs(frame->exposure - truth - unknowable), 1ms);
  }
}

TEST(OpenniSensor, ComesBackAfterItWasUnplugged) {
  DepthFeed feed;
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  for (std::uint64_t time = 1; time <= 3; ++time) {
    feed.plug(false);
    ASSERT_TRUE(waitUntil(*sensor, [&] { return sensor->status().state == DepthState::kLost; }));
    EXPECT_NE(sensor->status().message, "");
    feed.plug(true);
    ASSERT_TRUE(waitUntil(*sensor, [&] {
      return sensor->status().state == DepthState::kStreaming;
    })) << sensor->status().message;
    EXPECT_EQ(sensor->status().returns, time);
    EXPECT_EQ(sensor->status().message, "");
  }
}

TEST(OpenniSensor, IsLookedForWhileItIsNotThere) {
  auto feed = std::make_unique<DepthFeed>();
  feed->plug(false);
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "plug it in"), HasSubstr("no depth sensor found"));
  EXPECT_EQ(sensor->status().state, DepthState::kConnecting);
  feed->plug(true);
  EXPECT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  EXPECT_EQ(sensor->status().returns, 0u) << "it was never lost";
}

TEST(OpenniSensor, LetsADriverLookForASensorAsLongAsItTakes) {
  DepthFeed feed;
  feed.plug(false);
  const auto sensor = opened(live(), {.opening_patience = 3s});
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "plug it in"), HasSubstr("no depth sensor found"));
  const auto first = workers();
  ASSERT_EQ(first.size(), 1u);
  for (const rt::Timestamp end = rt::now() + 5s; rt::now() < end;)
    EXPECT_FALSE(sensor->waitFrame(100ms));
  EXPECT_EQ(workers(), first) << "the same process";
  EXPECT_THAT(sensor->status().message, HasSubstr("no depth sensor found"));
}

TEST(OpenniSensor, GivesTheDriverFewPrivileges) {
  const DepthFeed feed;
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  const auto running = workers();
  ASSERT_EQ(running.size(), 1u);
  const std::filesystem::path proc = "/proc/" + std::to_string(running.front());
  int oom_score_adj = 0;
  std::ifstream(proc / "oom_score_adj") >> oom_score_adj;
  EXPECT_EQ(oom_score_adj, 500);
  std::stringstream limits;
  limits << std::ifstream(proc / "limits").rdbuf();
  EXPECT_THAT(limits.str(), testing::ContainsRegex("Max core file size +0 +0"));
  EXPECT_THAT(limits.str(), testing::ContainsRegex("Max realtime priority +0 +0"));
}

TEST(OpenniSensor, SurvivesADriverThatCrashes) {
  const DepthFeed feed;
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  const auto first = workers();
  ASSERT_EQ(first.size(), 1u);
  ::kill(first.front(), SIGSEGV);
  ASSERT_TRUE(waitUntil(*sensor, [&] { return sensor->status().returns == 1; }))
      << sensor->status().message;
  ASSERT_EQ(workers().size(), 1u);
  EXPECT_NE(workers().front(), first.front());
}

TEST(OpenniSensor, SurvivesADriverThatHangs) {
  const DepthFeed feed;
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  const auto first = workers();
  ASSERT_EQ(first.size(), 1u);
  ::kill(first.front(), SIGSTOP);
  EXPECT_THAT(messageAbout(*sensor, "fell silent"), HasSubstr("check its cable"));
  ASSERT_TRUE(waitUntil(*sensor, [&] { return sensor->status().returns == 1; }))
      << sensor->status().message;
}

TEST(OpenniSensor, LeavesNoProcessBehind) {
  const DepthFeed feed;
  auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  ASSERT_EQ(workers().size(), 1u);
  sensor.reset();
  EXPECT_TRUE(workers().empty());
}

TEST(OpenniSensor, RemovesWhatAKilledDriverLeftBehind) {
  const TemporaryFolder scratch;
  std::filesystem::create_directories(scratch / "tmp");
  const auto stages = [&scratch] {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(scratch / "tmp"))
      found.push_back(entry.path().filename());
    return found;
  };
  const char* usual = std::getenv("TMPDIR");
  const std::string before = usual == nullptr ? "" : usual;
  ::setenv("TMPDIR", (scratch / "tmp").c_str(), 1);
  {
    // Without a sensor its drivers stay at hand, until it is plugged in.
    DepthFeed feed;
    feed.plug(false);
    const auto sensor = opened(live());
    ASSERT_TRUE(sensor);
    EXPECT_THAT(messageAbout(*sensor, "plug it in"), HasSubstr("no depth sensor found"));
    const auto first = stages();
    ASSERT_EQ(first.size(), 1u);
    const auto killed = workers();
    ASSERT_EQ(killed.size(), 1u);
    ::kill(killed.front(), SIGKILL);
    // The next one sweeps before it makes its own.
    EXPECT_TRUE(waitUntil(*sensor, [&] { return stages().size() == 1 && stages() != first; }));
    // While one lives, another lets it be.
    const auto other = opened(live());
    ASSERT_TRUE(other);
    EXPECT_TRUE(waitUntil(*other, [&] { return stages().size() == 2; }));
    feed.plug(true);
    EXPECT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
    EXPECT_TRUE(other->waitFrame(20s)) << other->status().message;
  }
  EXPECT_THAT(stages(), testing::IsEmpty());
  if (usual == nullptr)
    ::unsetenv("TMPDIR");
  else
    ::setenv("TMPDIR", before.c_str(), 1);
}

TEST(OpenniSensor, SaysWhatASensorOfAnotherResolutionRuns) {
  const DepthFeed feed(DepthFeed::sized(160, 120));
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  const auto frame = sensor->waitFrame(20s);
  ASSERT_TRUE(frame) << sensor->status().message;
  EXPECT_EQ(frame->width_px, 160u);
  EXPECT_EQ(frame->depth_mm.size(), 160u * 120u);
  EXPECT_THAT(sensor->status().message, HasSubstr("no 320x240 at 30 Hz: runs 160x120 at 30 Hz"));
}

TEST(OpenniSensor, TakesASensorOfAnotherSizeInTheSamePlace) {
  auto feed = std::make_unique<DepthFeed>();
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  feed.reset();
  ASSERT_TRUE(waitUntil(*sensor, [&] { return sensor->status().state == DepthState::kLost; }));
  feed = std::make_unique<DepthFeed>(DepthFeed::sized(160, 120));
  const auto frame = sensor->waitFrame(20s);
  ASSERT_TRUE(frame) << sensor->status().message;
  EXPECT_EQ(frame->width_px, 160u);
}

TEST(OpenniSensor, GoesOnWithoutColour) {
  auto format = DepthFeed::small();
  format.colour = false;
  const DepthFeed feed(format);
  const auto sensor = opened(live());
  ASSERT_TRUE(sensor);
  const auto frame = sensor->waitFrame(20s);
  ASSERT_TRUE(frame) << sensor->status().message;
  EXPECT_FALSE(frame->depth_mm.empty());
  EXPECT_TRUE(frame->colour_rgb.empty());
  EXPECT_FALSE(sensor->status().colour);
  EXPECT_THAT(sensor->status().message, HasSubstr("it has no colour"));
}

TEST(OpenniSensor, SaysWhatIsWrongWithTheDriverFolder) {
  hal::DepthSensorSettings settings = live();
  settings.drivers = "/nowhere/Drivers";
  auto sensor = opened(settings);
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "there is no such folder"), HasSubstr("/nowhere/Drivers"));
  const TemporaryFolder empty;
  settings.drivers = empty.path();
  sensor = opened(settings);
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "no OpenNI2 driver"), HasSubstr("OpenNI2/Drivers"));
  EXPECT_EQ(sensor->status().state, DepthState::kConnecting);
}

TEST(OpenniSensor, LooksOnWhereADriverIsNone) {
  const TemporaryFolder drivers;
  std::ofstream(drivers / "libbroken.so") << "not a library";
  hal::DepthSensorSettings settings = live();
  settings.drivers = drivers.path();
  const auto sensor = opened(settings);
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "no depth sensor found"), HasSubstr("depth_sensor.drivers"));
}

TEST(Recordings, ThatAreMissingOrNoneSaySo) {
  const TemporaryFolder scratch;
  auto sensor = opened({.source = scratch / "nowhere.oni"});
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "cannot be played"), HasSubstr("nowhere.oni"));
  std::ofstream(scratch / "text.oni") << "not a recording";
  sensor = opened({.source = scratch / "text.oni"});
  ASSERT_TRUE(sensor);
  EXPECT_THAT(messageAbout(*sensor, "cannot be played"), HasSubstr("copied whole"));
}

/// Everything of a recording, as fast as it goes.
struct Played {
  std::vector<std::uint64_t> numbers;
  std::vector<rt::Nanoseconds> since_first;
  std::vector<std::vector<std::uint16_t>> depth_mm;
  std::vector<std::vector<std::uint8_t>> colour_rgb;
};
Played playAll(hal::DepthSensor& sensor) {
  Played played;
  rt::Timestamp first;
  const rt::Timestamp end = rt::now() + 60s;
  while (sensor.status().state != DepthState::kEnded && rt::now() < end) {
    const auto frame = sensor.waitFrame(500ms);
    if (!frame) continue;
    if (played.numbers.empty()) first = frame->exposure;
    played.numbers.push_back(frame->number);
    played.since_first.push_back(frame->exposure - first);
    played.depth_mm.emplace_back(frame->depth_mm.begin(), frame->depth_mm.end());
    played.colour_rgb.emplace_back(frame->colour_rgb.begin(), frame->colour_rgb.end());
  }
  EXPECT_EQ(sensor.status().state, DepthState::kEnded) << sensor.status().message;
  return played;
}

TEST(Recordings, OfAFolderAndOfAnOniFileAreEqualPictureByPicture) {
  const TemporaryFolder scratch;
  ASSERT_TRUE(test::recordOni(scratch, scratch / "a.oni"));
  ASSERT_TRUE(test::runDepth(scratch, {"export", "--source", scratch / "a.oni", scratch / "f"}));
  const auto oni =
      opened({.source = scratch / "a.oni", .repeat = false}, {.play = Play::kEveryFrame});
  ASSERT_TRUE(oni);
  auto folder =
      FolderSensor::open({.folder = scratch / "f", .play = Play::kEveryFrame, .repeat = false});
  ASSERT_TRUE(folder) << folder.error();
  const Played a = playAll(*oni);
  const Played b = playAll(**folder);
  ASSERT_GE(a.numbers.size(), 20u);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_TRUE(a.since_first == b.since_first);
  EXPECT_TRUE(a.depth_mm == b.depth_mm);
  EXPECT_TRUE(a.colour_rgb == b.colour_rgb);
  EXPECT_FALSE(a.colour_rgb.front().empty());
}

TEST(Recordings, ArePlayedToTheirLastWholePictureWhereTheirEndIsMissing) {
  const TemporaryFolder scratch;
  {
    const DepthFeed feed;
    test::ChildProcess recorder({KAGAMI_DEPTH, "record", "--drivers", KAGAMI_DEPTH_DRIVERS,
                                 "--seconds", "60", scratch / "cut.oni"},
                                scratch / "log");
    const rt::Timestamp end = rt::now() + 30s;
    std::error_code none;
    while (rt::now() < end && (!std::filesystem::exists(scratch / "cut.oni", none) ||
                               std::filesystem::file_size(scratch / "cut.oni", none) < 8'000'000))
      std::this_thread::sleep_for(20ms);
  }  // killed in the middle of a picture
  const auto sensor =
      opened({.source = scratch / "cut.oni", .repeat = false}, {.play = Play::kEveryFrame});
  ASSERT_TRUE(sensor);
  const Played played = playAll(*sensor);
  EXPECT_GE(played.numbers.size(), 5u) << sensor->status().message;
}

TEST(Recordings, CopiedInPartArePlayedAsFarAsTheyGo) {
  const TemporaryFolder scratch;
  ASSERT_TRUE(test::recordOni(scratch, scratch / "a.oni"));
  const auto size = std::filesystem::file_size(scratch / "a.oni");
  std::filesystem::resize_file(scratch / "a.oni", size / 2);
  const auto sensor =
      opened({.source = scratch / "a.oni", .repeat = false}, {.play = Play::kEveryFrame});
  ASSERT_TRUE(sensor);
  const Played played = playAll(*sensor);
  EXPECT_GE(played.numbers.size(), 5u) << sensor->status().message;
}

TEST(Recordings, WithoutColourHaveDepthAlone) {
  const TemporaryFolder scratch;
  auto format = DepthFeed::small();
  format.colour = false;
  ASSERT_TRUE(test::recordOni(scratch, scratch / "a.oni", format));
  const auto sensor = opened({.source = scratch / "a.oni"}, {.play = Play::kEveryFrame});
  ASSERT_TRUE(sensor);
  const auto frame = sensor->waitFrame(20s);
  ASSERT_TRUE(frame) << sensor->status().message;
  EXPECT_EQ(frame->depth_mm.size(), format.pixels());
  EXPECT_TRUE(frame->colour_rgb.empty());
  EXPECT_THAT(sensor->status().message, HasSubstr("it has no colour"));
}

TEST(Recordings, RepeatWhereAsked) {
  const TemporaryFolder scratch;
  ASSERT_TRUE(test::recordOni(scratch, scratch / "a.oni"));
  const auto sensor = opened({.source = scratch / "a.oni"}, {.play = Play::kEveryFrame});
  ASSERT_TRUE(sensor);
  std::uint64_t last = 0;
  int restarts = 0;
  for (int i = 0; i < 120; ++i) {
    const auto frame = sensor->waitFrame(20s);
    ASSERT_TRUE(frame) << sensor->status().message;
    if (frame->number < last) ++restarts;
    last = frame->number;
  }
  EXPECT_GE(restarts, 1);
  EXPECT_EQ(sensor->status().lost, 0u);
  EXPECT_EQ(sensor->status().state, DepthState::kStreaming);
}

}  // namespace
