#include "appliance/tools/status_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appliance/status/status.h"

namespace {

using appliance::GenlockReason;
using appliance::GenlockState;
using appliance::Status;
using testing::HasSubstr;
using testing::Not;

Status someStatus() {
  Status status;
  status.genlock = {.state = GenlockState::kLocked,
                    .hold_over = true,
                    .vblanks_per_trigger = 2,
                    .phase_error = rt::Nanoseconds(-1500),
                    .phase_error_rms_ns = 6400,
                    .lead = std::chrono::microseconds(25040),
                    .vblank_period_ns = 12.5e6};
  status.genlock_text = "locked: as it should";
  status.renderer = "a test";
  return status;
}

TEST(Status, TellsTheGenlockInNumbersWithUnits) {
  Status status = someStatus();
  status.genlock.unlocks = 3;
  status.genlock.last_unlock = GenlockReason::kPhaseLost;
  const auto genlock = nlohmann::json::parse(appliance::toJson(status)).at("genlock");
  EXPECT_EQ(genlock.at("state"), "locked");
  EXPECT_EQ(genlock.at("reason"), "none");
  EXPECT_EQ(genlock.at("text"), "locked: as it should");
  EXPECT_EQ(genlock.at("hold_over"), true);
  EXPECT_EQ(genlock.at("vblanks_per_trigger"), 2);
  EXPECT_DOUBLE_EQ(genlock.at("phase_error_us").get<double>(), -1.5);
  EXPECT_DOUBLE_EQ(genlock.at("phase_error_rms_us").get<double>(), 6.4);
  EXPECT_DOUBLE_EQ(genlock.at("lead_ms").get<double>(), 25.04);
  EXPECT_EQ(genlock.at("unlocks"), 3);
  EXPECT_EQ(genlock.at("last_unlock"), "phase_lost");
}

TEST(StatusText, HasALineForTheGenlockAndItsLosses) {
  Status status = someStatus();
  const auto text = appliance::statusText(appliance::toJson(status));
  ASSERT_TRUE(text.has_value()) << text.error();
  EXPECT_THAT(*text, HasSubstr("genlock  locked: as it should\n"));
  EXPECT_THAT(*text, Not(HasSubstr("lost 0 times")));
  status.genlock.unlocks = 3;
  status.genlock.last_unlock = GenlockReason::kNoVblanks;
  EXPECT_THAT(*appliance::statusText(appliance::toJson(status)),
              HasSubstr("; lost 3 times, the last by no_vblanks\n"));
}

TEST(Status, HasTheSectionsOfThePartsAsLineAndValues) {
  Status status = someStatus();
  status.sections = {
      {.key = "depth",
       .line = "streaming: a sensor",
       .values = {{"rate_hz", 29.5}, {"lost", std::int64_t{3}}, {"colour", true}}},
      {.key = "commands", .line = "", .values = {{"panel_refused", std::int64_t{0}}}}};
  const auto sections = nlohmann::json::parse(appliance::toJson(status)).at("sections");
  EXPECT_EQ(
      sections.at("depth"),
      (nlohmann::json{
          {"line", "streaming: a sensor"}, {"rate_hz", 29.5}, {"lost", 3}, {"colour", true}}));
  EXPECT_EQ(sections.at("commands").at("panel_refused"), 0);
}

TEST(StatusText, HasALineForEverySectionThatHasOne) {
  Status status = someStatus();
  status.sections = {{.key = "depth", .line = "streaming"},
                     {.key = "commands", .line = ""},
                     {.key = "calibration", .line = "3 of 20 views"}};
  const auto text = appliance::statusText(appliance::toJson(status));
  ASSERT_TRUE(text.has_value()) << text.error();
  EXPECT_THAT(*text, HasSubstr("depth    streaming\ncalibration 3 of 20 views\n"));
  EXPECT_THAT(*text, Not(HasSubstr("commands")));
}

TEST(StatusText, SaysWhatIsWrongWithACameraAndWhatToDo) {
  Status status = someStatus();
  status.cameras = {{.name = "left", .state = appliance::CameraState::kStreaming},
                    {.name = "right",
                     .state = appliance::CameraState::kLost,
                     .trouble = appliance::CameraTrouble::kNoAnswer,
                     .reason = "no frames since 0.4 s: check its cable",
                     .frames_lost = 2,
                     .frames_away = 16}};
  const auto text = appliance::statusText(appliance::toJson(status));
  ASSERT_TRUE(text.has_value()) << text.error();
  EXPECT_THAT(*text, HasSubstr("camera 2 (right): lost: no frames since 0.4 s: check its cable; 2 "
                               "lost, 0 incomplete, 16 while away\n"));
  EXPECT_THAT(*text, Not(HasSubstr("left"))) << "all is well with it";
}

}  // namespace
