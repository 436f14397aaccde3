#include "appliance/depth/depth_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::DepthReport;
using appliance::depthText;
using testing::HasSubstr;

std::string troubleText(const DepthReport& report) {
  return textOf(appliance::depthTrouble(report));
}

TEST(DepthText, TellsWhatStreamsInOneLine) {
  DepthReport report{.sensor = {.state = hal::DepthState::kStreaming,
                                .name = "Acme RGB-D",
                                .width_px = 640,
                                .height_px = 480,
                                .colour = true,
                                .frames = 900,
                                .lost = 2},
                     .rate_hz = 29.97};
  EXPECT_EQ(depthText(report),
            "streaming: Acme RGB-D, 640x480 with colour, 30.0 Hz; 900 pictures, 2 lost");
  EXPECT_EQ(troubleText(report), "");
  report.sensor.returns = 3;
  report.sensor.without_colour = 4;
  EXPECT_THAT(depthText(report), HasSubstr("2 lost, 4 without their colour; came back 3 times"));
}

TEST(DepthText, HasNoNumbersOfASensorThatWasNeverThere) {
  DepthReport report;
  report.sensor.message = "no depth sensor found: plug it in";
  EXPECT_EQ(depthText(report), "connecting");
  EXPECT_EQ(troubleText(report), "no depth sensor found: plug it in");
}

TEST(DepthText, NamesEachReaderThatTookAPicture) {
  DepthReport report{.sensor = {.state = hal::DepthState::kStreaming, .name = "Acme", .frames = 9},
                     .readers = {{.name = "snapshot", .pins = 1, .taken = 3, .lost = 1},
                                 {.name = "idle", .pins = 2}}};
  EXPECT_THAT(depthText(report), HasSubstr("; reader snapshot took 3 and lost 1"));
  EXPECT_THAT(depthText(report), testing::Not(HasSubstr("idle")));
  report.readers[0].refused = 2;
  EXPECT_THAT(depthText(report), HasSubstr("refused 2 times because it kept 1 pictures"));
}

TEST(DepthText, SaysWhatTheSensorSees) {
  DepthReport report{.sensor = {.state = hal::DepthState::kStreaming, .name = "Acme", .frames = 9},
                     .sight = appliance::DepthSight{.measured_share = 0.824, .middle_m = 3.944}};
  EXPECT_THAT(depthText(report), HasSubstr("; measures 82 % of its pixels, 3.94 m in the middle"));
  report.sight->middle_m.reset();
  EXPECT_THAT(depthText(report), HasSubstr("nothing in the middle"));
}

TEST(DepthText, SaysHowOldTheLastPictureOfALostSensorIs) {
  DepthReport report{.sensor = {.state = hal::DepthState::kLost, .name = "Acme", .frames = 9},
                     .age = std::chrono::milliseconds(12'300)};
  EXPECT_THAT(depthText(report), HasSubstr("; the last picture was taken 12 s ago"));
  report.sensor.state = hal::DepthState::kStreaming;
  EXPECT_THAT(depthText(report), testing::Not(HasSubstr("ago")));
}

TEST(DepthText, SaysThatARecordingIsOver) {
  DepthReport report{.sensor = {.state = hal::DepthState::kEnded, .name = "a.oni", .frames = 60}};
  EXPECT_THAT(depthText(report), HasSubstr("ended: a.oni"));
  EXPECT_THAT(troubleText(report), HasSubstr("depth_sensor.repeat"));
}

}  // namespace
