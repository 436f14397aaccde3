#include "appliance/jobs/job_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/jobs/job_thread.h"
#include "tests/support/becomes_true.h"

namespace {

using appliance::JobRegistry;
using appliance::JobReport;
using appliance::JobState;
using appliance::WhenOwnerLeaves;
using testing::ElementsAre;
using testing::HasSubstr;

/// A work that a test holds in its hands.
struct Hand {
  JobReport report;
  bool cancelled = false;
  bool destroyed = false;
};

class HandWork : public appliance::JobWork {
 public:
  explicit HandWork(Hand& hand) : hand_(hand) {}
  ~HandWork() override { hand_.destroyed = true; }
  HandWork(const HandWork&) = delete;
  HandWork& operator=(const HandWork&) = delete;
  [[nodiscard]] JobReport report() const override { return hand_.report; }
  void cancel() override { hand_.cancelled = true; }

 private:
  Hand& hand_;
};

appliance::JobOrder orderOf(Hand& hand, const std::string& owner = "",
                            WhenOwnerLeaves when = WhenOwnerLeaves::kGoesOn) {
  return {.kind = "check",
          .owner = owner,
          .when_owner_leaves = when,
          .work = std::make_unique<HandWork>(hand)};
}

TEST(JobRegistry, ReportsAJobFromItsBeginToItsEnd) {
  Hand hand;
  JobRegistry jobs;
  const auto id = jobs.start(orderOf(hand));
  ASSERT_TRUE(id.has_value()) << textOf(id.error());
  EXPECT_THAT(jobs.look().begun, ElementsAre(*id));
  EXPECT_EQ(jobs.look(), JobRegistry::Changes{});
  hand.report.progress = 0.5;
  EXPECT_THAT(jobs.look().changed, ElementsAre(*id));
  EXPECT_EQ(jobs.find(*id)->report.progress, 0.5);
  hand.report = {.state = JobState::kDone, .progress = 1, .result = "all good"};
  EXPECT_THAT(jobs.look().changed, ElementsAre(*id));
  EXPECT_TRUE(hand.destroyed);
  EXPECT_EQ(jobs.find(*id)->report.result, "all good");
  EXPECT_EQ(jobs.look(), JobRegistry::Changes{});
}

TEST(JobRegistry, CancelsARunningJobAndLeavesAnEndedOneAlone) {
  Hand hand;
  JobRegistry jobs;
  const auto id = jobs.start(orderOf(hand)).value();
  EXPECT_TRUE(jobs.cancel(id));
  EXPECT_TRUE(hand.cancelled);
  EXPECT_EQ(jobs.find(id)->report.state, JobState::kRunning) << "until the work says so";
  hand.report.state = JobState::kCancelled;
  (void)jobs.look();
  EXPECT_EQ(jobs.find(id)->report.state, JobState::kCancelled);
  EXPECT_TRUE(jobs.cancel(id));
  EXPECT_FALSE(jobs.cancel(id + 1));
}

TEST(JobRegistry, AnOwnerThatLeavesEndsOnlyWhatIsToEndWithIt) {
  Hand stays;
  Hand ends;
  Hand other;
  JobRegistry jobs;
  (void)jobs.start(orderOf(stays, ":1.5", WhenOwnerLeaves::kGoesOn));
  (void)jobs.start(orderOf(ends, ":1.5", WhenOwnerLeaves::kIsCancelled));
  (void)jobs.start(orderOf(other, ":1.6", WhenOwnerLeaves::kIsCancelled));
  jobs.ownerLeft(":1.5");
  EXPECT_FALSE(stays.cancelled);
  EXPECT_TRUE(ends.cancelled);
  EXPECT_FALSE(other.cancelled);
}

TEST(JobRegistry, RefusesMoreThanItCanRun) {
  std::array<Hand, JobRegistry::kMostRunning> hands;
  Hand one_more;
  JobRegistry jobs;
  for (Hand& hand : hands) EXPECT_TRUE(jobs.start(orderOf(hand)).has_value());
  EXPECT_THAT(textOf(jobs.start(orderOf(one_more)).error()), HasSubstr("wait for one of them"));
  hands[0].report.state = JobState::kFailed;
  (void)jobs.look();
  EXPECT_TRUE(jobs.start(orderOf(one_more)).has_value());
}

TEST(JobRegistry, KeepsTheLastOnesThatEndedAndForgetsTheOldest) {
  Hand running;
  JobRegistry jobs;
  const auto first = jobs.start(orderOf(running)).value();
  std::vector<appliance::JobId> forgotten;
  for (std::size_t i = 0; i < JobRegistry::kMostKept + 3; ++i) {
    Hand hand{.report = {.state = JobState::kDone}};
    (void)jobs.start(orderOf(hand));
    for (const auto id : jobs.look().forgotten) forgotten.push_back(id);
  }
  EXPECT_THAT(forgotten, ElementsAre(first + 1, first + 2, first + 3));
  EXPECT_EQ(jobs.ids().size(), JobRegistry::kMostKept + 1);
  EXPECT_NE(jobs.find(first), nullptr) << "it still runs";
}

TEST(JobThread, ReportsProgressAndResult) {
  auto work = appliance::JobThread::start(
      [](appliance::JobThread::Progress& progress, const std::stop_token&) {
        progress.set(0.25);
        return std::expected<std::string, std::string>("seen");
      });
  ASSERT_TRUE(work.has_value()) << textOf(work.error());
  ASSERT_TRUE(test::becomesTrue([&] { return (*work)->report().state == JobState::kDone; }));
  EXPECT_EQ((*work)->report().result, "seen");
  EXPECT_EQ((*work)->report().progress, 1);
}

TEST(JobThread, EndsEarlyWhenItIsCancelled) {
  auto work =
      appliance::JobThread::start([](appliance::JobThread::Progress&, const std::stop_token& stop) {
        while (!stop.stop_requested()) std::this_thread::yield();
        return std::expected<std::string, std::string>("half");
      });
  ASSERT_TRUE(work.has_value()) << textOf(work.error());
  EXPECT_EQ((*work)->report().state, JobState::kRunning);
  (*work)->cancel();
  ASSERT_TRUE(test::becomesTrue([&] { return (*work)->report().state == JobState::kCancelled; }));
}

TEST(JobThread, AnExceptionIsAFailureWithItsWords) {
  auto work = appliance::JobThread::start(
      [](appliance::JobThread::Progress&,
         const std::stop_token&) -> std::expected<std::string, std::string> {
        throw std::runtime_error("disk full");
      });
  ASSERT_TRUE(work.has_value()) << textOf(work.error());
  ASSERT_TRUE(test::becomesTrue([&] { return (*work)->report().state == JobState::kFailed; }));
  EXPECT_THAT((*work)->report().result, HasSubstr("disk full"));
}

}  // namespace
