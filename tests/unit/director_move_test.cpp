#include <chrono>

#include <gtest/gtest.h>

#include "appliance/director/move.h"

namespace {

using appliance::Move;
using std::chrono::milliseconds;
using std::chrono::seconds;

const rt::Timestamp kBegin = rt::fromNs(1'000'000'000);

TEST(Move, GoesAtItsSpeedAndEndsExactly) {
  const Move move{.from_deg = 10, .to_deg = 40, .speed_deg_per_s = 15, .begin = kBegin};
  EXPECT_DOUBLE_EQ(move.angle(kBegin - seconds(1)), 10);
  EXPECT_DOUBLE_EQ(move.angle(kBegin + seconds(1)), 25);
  EXPECT_EQ(move.end(), kBegin + seconds(2));
  EXPECT_DOUBLE_EQ(move.angle(move.end()), 40);
  EXPECT_DOUBLE_EQ(move.angle(move.end() + seconds(9)), 40);
}

TEST(Move, EasedEndsTakeTwiceTheirTimeAndTheMiddleKeepsItsSpeed) {
  const Move move{
      .from_deg = 0, .to_deg = -40, .speed_deg_per_s = 20, .ease = 0.25, .begin = kBegin};
  EXPECT_EQ(move.end(), kBegin + seconds(3));
  EXPECT_NEAR(move.angle(kBegin + milliseconds(500)), -2.5, 1e-9);
  EXPECT_NEAR(move.angle(kBegin + seconds(1)), -10, 1e-9);
  EXPECT_NEAR(move.angle(kBegin + seconds(2)), -30, 1e-9);
  EXPECT_NEAR(move.angle(kBegin + milliseconds(2500)), -37.5, 1e-9);
}

TEST(Move, RestsAtItsEndBeforeItIsOver) {
  const Move move{.from_deg = 0,
                  .to_deg = 10,
                  .speed_deg_per_s = 10,
                  .pause = milliseconds(300),
                  .begin = kBegin};
  EXPECT_EQ(move.arrival(), kBegin + seconds(1));
  EXPECT_EQ(move.end(), kBegin + milliseconds(1300));
}

TEST(Move, WithoutASpeedOrAWayTakesNoTime) {
  EXPECT_EQ((Move{.from_deg = 0, .to_deg = 10, .begin = kBegin}.end()), kBegin);
  EXPECT_DOUBLE_EQ((Move{.from_deg = 0, .to_deg = 10, .begin = kBegin}.angle(kBegin)), 10);
  EXPECT_EQ((Move{.from_deg = 5, .to_deg = 5, .speed_deg_per_s = 3, .begin = kBegin}.end()),
            kBegin);
}

}  // namespace
