#include "appliance/journal/condition_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::Condition;
using appliance::ConditionLog;
using appliance::JournalLine;
using appliance::LogLevel;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Now = Condition::Now;

Condition pulled(const std::string& kind = "") {
  return {.key = "panel", .kind = kind, .text = "panel: pulled " + kind, .end = "panel: back"};
}

class Journal : public testing::Test {
 protected:
  std::vector<JournalLine> at(rt::Nanoseconds time, const std::vector<Condition>& conditions) {
    return log.look(rt::fromNs(1'000'000'000) + time, conditions);
  }
  std::vector<JournalLine> at(int ms, const std::vector<Condition>& conditions) {
    return at(rt::Nanoseconds(milliseconds(ms)), conditions);
  }
  ConditionLog log;
};

TEST_F(Journal, HasALineAtTheBeginAndOneAtTheEndOfACondition) {
  EXPECT_THAT(at(0, {}), IsEmpty());
  EXPECT_THAT(at(100, {pulled()}), ElementsAre(JournalLine{LogLevel::kWarning, "panel: pulled "}));
  for (int ms = 200; ms < 2'600; ms += 100) EXPECT_THAT(at(ms, {pulled()}), IsEmpty());
  EXPECT_THAT(at(2'600, {}),
              ElementsAre(JournalLine{LogLevel::kNotice, "panel: back (after 2.5 s)"}));
  EXPECT_THAT(at(2'700, {}), IsEmpty());
}

TEST_F(Journal, SaysTheSameTroubleAgainHoweverOftenItComesInANight) {
  int lines = 0;
  for (int hour = 0; hour < 40; ++hour) {
    lines += static_cast<int>(at(std::chrono::hours(hour), {pulled()}).size());
    lines += static_cast<int>(at(std::chrono::hours(hour) + seconds(3), {}).size());
  }
  EXPECT_EQ(lines, 80);
}

TEST_F(Journal, SumsAConditionThatComesAndGoesAllTheTime) {
  std::vector<JournalLine> lines;
  for (int ms = 0; ms < 60'000; ms += 200) {
    for (auto& line : at(ms, {pulled()})) lines.push_back(line);
    for (auto& line : at(ms + 100, {})) lines.push_back(line);
  }
  EXPECT_GE(lines.size(), 10u);
  EXPECT_LE(lines.size(), 13u);  // six at first, then one each ten seconds
  EXPECT_THAT(lines.back().text, HasSubstr("times since the last line)"));
  // The end is reported, however late.
  const auto last = at(120'000, {});
  for (const JournalLine& line : last) EXPECT_THAT(line.text, HasSubstr("over now"));
  EXPECT_THAT(at(240'000, {}), IsEmpty());
}

TEST_F(Journal, CountsWhatItSums) {
  std::uint64_t begins = 0;
  std::uint64_t told = 0;
  const auto count = [&](const std::vector<JournalLine>& lines) {
    for (const JournalLine& line : lines) {
      const auto bracket = line.text.find(" (");
      const bool sum = line.text.find("times since") != std::string::npos;
      if (sum) told += std::stoull(line.text.substr(bracket + 2));
      if (!sum && line.text.starts_with("panel: pulled")) ++told;
    }
  };
  for (int ms = 0; ms < 100'000; ms += 200) {
    ++begins;
    count(at(ms, {pulled()}));
    count(at(ms + 100, {}));
  }
  count(at(120'000, {}));
  EXPECT_EQ(told, begins);
}

TEST_F(Journal, AnotherKindIsALineOfItsOwn) {
  EXPECT_THAT(at(0, {pulled("a")}),
              ElementsAre(testing::Field(&JournalLine::text, "panel: pulled a")));
  EXPECT_THAT(at(100, {pulled("b")}),
              ElementsAre(testing::Field(&JournalLine::text, "panel: pulled b")));
  EXPECT_THAT(at(200, {pulled("b")}), IsEmpty());
}

TEST_F(Journal, ATextThatChangesWhileItLastsIsNoNews) {
  Condition silent{.key = "sensor", .text = "sensor: silent for 0.4 s", .end = "sensor: back"};
  EXPECT_EQ(at(0, {silent}).size(), 1u);
  silent.text = "sensor: silent for 0.5 s";
  EXPECT_THAT(at(100, {silent}), IsEmpty());
}

TEST_F(Journal, WhatIsUnclearNeitherBeginsNorEnds) {
  Condition camera = pulled();
  camera.now = Now::kUnclear;
  EXPECT_THAT(at(0, {camera}), IsEmpty());
  camera.now = Now::kHolds;
  EXPECT_EQ(at(100, {camera}).size(), 1u);
  camera.now = Now::kUnclear;
  EXPECT_THAT(at(200, {camera}), IsEmpty());
  camera.now = Now::kHolds;
  EXPECT_THAT(at(300, {camera}), IsEmpty());
  camera.now = Now::kOver;
  EXPECT_EQ(at(400, {camera}).size(), 1u);
}

TEST_F(Journal, SaysWhatItsSourceCountedBetweenTwoLooks) {
  Condition lock{.key = "genlock", .level = LogLevel::kNotice, .text = "locked", .begins = 1};
  EXPECT_THAT(at(0, {lock}), ElementsAre(testing::Field(&JournalLine::text, "locked")));
  lock.begins = 2;
  EXPECT_THAT(at(100, {lock}), ElementsAre(testing::Field(&JournalLine::text, "locked")));
  lock.begins = 5;
  EXPECT_THAT(at(200, {lock}),
              ElementsAre(testing::Field(&JournalLine::text, HasSubstr("3 times"))));
}

TEST_F(Journal, TakesTheEndsTextFromTheMomentOfTheEnd) {
  Condition lock{.key = "genlock", .text = "locked", .end_level = LogLevel::kWarning};
  EXPECT_EQ(at(0, {lock}).size(), 1u);
  lock.now = Now::kOver;
  lock.end = "phase lost";
  EXPECT_THAT(at(1'000, {lock}),
              ElementsAre(JournalLine{LogLevel::kWarning, "phase lost (after 1.0 s)"}));
}

TEST_F(Journal, AFloodOfDifferentTextsIsHeldBackAndForgotten) {
  std::size_t lines = 0;
  for (int i = 0; i < 3'000; ++i)
    lines += at(i, {{.key = "driver " + std::to_string(i), .text = "odd"}}).size();
  EXPECT_LE(lines, 104u);  // a hundred, then one a second
  EXPECT_LE(log.remembered(), ConditionLog::kMostRemembered + 1);
}

TEST_F(Journal, ForgetsWhatIsOverForLong) {
  EXPECT_EQ(at(0, {pulled()}).size(), 1u);
  EXPECT_EQ(at(100, {}).size(), 1u);
  EXPECT_EQ(log.remembered(), 1u);
  EXPECT_THAT(at(200'000, {}), IsEmpty());
  EXPECT_EQ(log.remembered(), 0u);
}

}  // namespace
