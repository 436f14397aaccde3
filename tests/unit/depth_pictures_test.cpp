// What hal/openni decides about pictures: pairs, modes, when a recording's are due.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/openni/pair_maker.h"
#include "hal/openni/play_clock.h"
#include "hal/openni/video_mode.h"

namespace {

using hal::openni::nearestMode;
using hal::openni::PairMaker;
using hal::openni::PlayClock;
using hal::openni::VideoMode;
using testing::ElementsAre;
using namespace std::chrono_literals;

struct Pairs {
  PairMaker<std::string> maker{16'666};
  std::vector<std::string> made;

  auto emit() {
    return [this](const std::string& depth, const std::optional<std::string>& colour) {
      made.push_back(depth + "+" + colour.value_or("-"));
    };
  }
  void depth(std::uint64_t us, const std::string& name) { maker.onDepth(us, name, emit()); }
  void colour(std::uint64_t us, const std::string& name) { maker.onColour(us, name, emit()); }
};

TEST(PairMaker, PutsPicturesOfOneMomentTogetherInEitherOrder) {
  Pairs pairs;
  pairs.depth(100'000, "d1");
  EXPECT_THAT(pairs.made, ElementsAre());
  pairs.colour(100'400, "c1");
  pairs.colour(133'700, "c2");
  pairs.depth(133'333, "d2");
  EXPECT_THAT(pairs.made, ElementsAre("d1+c1", "d2+c2"));
}

TEST(PairMaker, NeverLosesDepthForWantOfColour) {
  Pairs pairs;
  pairs.depth(100'000, "d1");
  pairs.depth(133'333, "d2");
  pairs.depth(166'666, "d3");
  pairs.colour(166'700, "c3");
  EXPECT_THAT(pairs.made, ElementsAre("d1+-", "d2+-", "d3+c3"));
}

TEST(PairMaker, DropsColourThatHasNoDepth) {
  Pairs pairs;
  pairs.colour(66'666, "c0");
  pairs.colour(100'000, "c1");
  pairs.depth(100'000, "d1");
  EXPECT_THAT(pairs.made, ElementsAre("d1+c1"));
}

TEST(PairMaker, GivesTheLastDepthAtTheEnd) {
  Pairs pairs;
  pairs.depth(100'000, "d1");
  pairs.maker.flush(pairs.emit());
  pairs.maker.flush(pairs.emit());
  EXPECT_THAT(pairs.made, ElementsAre("d1+-"));
}

const std::vector<VideoMode> kModes = {
    {320, 240, 30}, {320, 240, 60}, {640, 480, 30}, {1280, 1024, 30}, {640, 400, 30}};

TEST(NearestMode, TakesWhatIsWanted) {
  for (std::size_t i = 0; i < kModes.size(); ++i) EXPECT_EQ(nearestMode(kModes, kModes[i]), i);
}

TEST(NearestMode, TakesTheNearestSizeThenTheNearestRate) {
  EXPECT_EQ(nearestMode(kModes, {800, 600, 30}), 2u);
  EXPECT_EQ(nearestMode(kModes, {300, 200, 50}), 1u);
  EXPECT_EQ(nearestMode(kModes, {640, 480, 15}), 2u);
  EXPECT_EQ(nearestMode(kModes, {4096, 4096, 30}), 3u);
}

TEST(NearestMode, HasNoneWithoutUsableModes) {
  EXPECT_EQ(nearestMode({}, {640, 480, 30}), std::nullopt);
  const std::vector<VideoMode> broken = {{0, 480, 30}, {640, 480, 0}};
  EXPECT_EQ(nearestMode(broken, {640, 480, 30}), std::nullopt);
}

TEST(PlayClock, KeepsTheDistancesOfTheRecording) {
  PlayClock clock;
  const rt::Timestamp now = rt::fromNs(1'000'000'000);
  EXPECT_EQ(clock.due(500, now), now);
  EXPECT_EQ(clock.due(33'833, now + 5ms), now + 33'333us);
  EXPECT_EQ(clock.due(67'166, now + 2s), now + 66'666us) << "late: goes on immediately";
}

TEST(PlayClock, GoesOnAfterAJumpOfTheStamps) {
  PlayClock clock;
  const rt::Timestamp now = rt::fromNs(1'000'000'000);
  (void)clock.due(5'000'000, now);
  EXPECT_EQ(clock.due(100, now + 33ms), now + 33ms);
  EXPECT_EQ(clock.due(3'600'000'000, now + 66ms), now + 66ms);
}

}  // namespace
