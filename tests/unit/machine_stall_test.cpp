#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/machine/machine_probe.h"
#include "appliance/machine/stall.h"
#include "appliance/machine/stall_log.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;
using appliance::Stall;
using appliance::StallLog;
using appliance::stallOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr rt::Timestamp kStart = rt::fromNs(5'000'000'000);

Stall stall(std::uint32_t cpu, rt::Nanoseconds from, rt::Nanoseconds until) {
  return {.cpu = cpu, .begin = kStart + from, .end = kStart + until};
}

TEST(StallOf, SeesNothingInAPunctualProbe) {
  EXPECT_FALSE(stallOf(0, kStart, kStart, 5ms));
  EXPECT_FALSE(stallOf(0, kStart, kStart + 4999us, 5ms));
}

TEST(StallOf, LastsFromTheDueInstantToTheWaking) {
  const auto seen = stallOf(3, kStart, kStart + 40ms, 5ms);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->cpu, 3u);
  EXPECT_EQ(seen->begin, kStart);
  EXPECT_EQ(seen->length(), 40ms);
}

TEST(StallLog, SaysNothingOfAMachineThatNeverStoodStill) {
  EXPECT_EQ(StallLog().text(kStart), "");
}

TEST(StallLog, SaysHowLongHowLongAgoAndHowOften) {
  StallLog log;
  log.take(stall(0, 0ms, 55ms));
  log.take(stall(0, 1000ms, 1040ms));
  EXPECT_EQ(log.text(kStart + 13040ms),
            "this PC stood still for 40 ms 12 s ago (firmware or host); 2 times so far, "
            "55 ms at most");
}

TEST(StallLog, TakesStallsOfSeveralCpusThatOverlapAsOne) {
  StallLog log;
  log.take(stall(0, 0ms, 40ms));
  log.take(stall(1, 10ms, 50ms));
  log.take(stall(2, 45ms, 60ms));
  EXPECT_EQ(log.count(), 1u);
  EXPECT_EQ(log.longest(), 60ms);
  log.take(stall(1, 61ms, 70ms));
  EXPECT_EQ(log.count(), 2u);
}

TEST(StallLog, CountsAStallOfACpuThatReportsLate) {
  StallLog log;
  log.take(stall(0, 500ms, 520ms));
  log.take(stall(1, 0ms, 10ms));
  EXPECT_EQ(log.count(), 2u);
  EXPECT_THAT(log.text(kStart + 1520ms), StartsWith("this PC stood still for 20 ms 1 s ago"));
}

TEST(StallLog, ForgetsThatItWasRecent) {
  StallLog log;
  EXPECT_FALSE(log.within(60s, kStart));
  log.take(stall(0, 0ms, 40ms));
  EXPECT_TRUE(log.within(60s, kStart + 59s));
  EXPECT_FALSE(log.within(60s, kStart + 61s));
}

class RealTimeThrottle : public testing::Test {
 protected:
  void set(const std::string& name, const std::string& value) {
    const auto folder = proc_ / "sys/kernel";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name) << value << "\n";
  }
  [[nodiscard]] std::string line() const {
    return appliance::realTimeThrottle(proc_.path().string());
  }

 private:
  test::TemporaryFolder proc_;
};

TEST_F(RealTimeThrottle, IsNamedWithItsShare) {
  set("sched_rt_period_us", "1000000");
  set("sched_rt_runtime_us", "950000");
  EXPECT_THAT(line(), HasSubstr("back for 50 ms of every 1000 ms"));
}

TEST_F(RealTimeThrottle, IsNotThereWhereItIsSwitchedOff) {
  set("sched_rt_period_us", "1000000");
  set("sched_rt_runtime_us", "-1");
  EXPECT_EQ(line(), "");
  set("sched_rt_runtime_us", "1000000");
  EXPECT_EQ(line(), "");
}

TEST_F(RealTimeThrottle, IsNotKnownWithoutTheKernelsFiles) {
  EXPECT_EQ(line(), "");
}

TEST(MachineProbe, LooksOnEveryCpuOrNotAtAll) {
  appliance::MachineProbe probe(1h);  // no machine stands still for so long
  if (!probe.start()) {
    EXPECT_FALSE(probe.watches());
    return;
  }
  EXPECT_TRUE(probe.watches());
  const auto looked = [&] {
    for (std::size_t i = 0; i < probe.cpus(); ++i) {
      if (probe.lateness(i).summary().count < 5) return false;
    }
    return true;
  };
  for (int i = 0; i < 3000 && !looked(); ++i) std::this_thread::sleep_for(10ms);
  EXPECT_TRUE(looked());
  EXPECT_EQ(probe.stalls(), 0u);
  EXPECT_FALSE(probe.tryPop());
  probe.stop();
  EXPECT_FALSE(probe.watches());
}

TEST(MachineProbe, HandsOutEveryStallOnce) {
  appliance::MachineProbe probe(-1h);  // every waking counts as one
  if (!probe.start()) GTEST_SKIP() << "no permission for SCHED_FIFO here";
  while (probe.stalls() < 20) std::this_thread::sleep_for(1ms);
  probe.stop();
  std::uint64_t taken = 0;
  while (const auto stall = probe.tryPop()) {
    EXPECT_GE(stall->end, stall->begin);
    ++taken;
  }
  EXPECT_EQ(taken + probe.dropped(), probe.stalls());
}

}  // namespace
