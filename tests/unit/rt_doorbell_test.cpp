#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "rt/doorbell.h"
#include "rt/spsc_ring.h"

namespace {

using namespace std::chrono_literals;

TEST(Doorbell, RemembersARingThatCameBeforeTheWait) {
  rt::Doorbell bell;
  bell.ring();
  bell.ring();
  EXPECT_TRUE(bell.waitUntil(rt::now() + 1h));
  EXPECT_FALSE(bell.waitUntil(rt::now()));  // several rings, one wake-up
}

TEST(Doorbell, TimesOutAtTheDeadlineAndNotBefore) {
  rt::Doorbell bell;
  const auto deadline = rt::now() + 3ms;
  EXPECT_FALSE(bell.waitUntil(deadline));
  EXPECT_GE(rt::now(), deadline);
}

TEST(Doorbell, TellsARingEvenWhenTheDeadlineHasPassed) {
  rt::Doorbell bell;
  bell.ring();
  EXPECT_TRUE(bell.waitUntil(rt::now() - 1s));
}

TEST(Doorbell, WakesAWaiterFromAnotherThread) {
  rt::Doorbell bell;
  std::jthread ringer([&] {
    std::this_thread::sleep_for(2ms);
    bell.ring();
  });
  EXPECT_TRUE(bell.waitUntil(rt::now() + 30s));
}

TEST(Doorbell, LosesNoWakeUpInAPingPongWithoutTimeouts) {
  constexpr int kRounds = 20'000;
  rt::Doorbell ping;
  rt::Doorbell pong;
  std::jthread peer([&] {
    for (int i = 0; i < kRounds; ++i) {
      if (!ping.waitUntil(rt::now() + 1h)) return;
      pong.ring();
    }
  });
  int answered = 0;
  for (int i = 0; i < kRounds; ++i) {
    ping.ring();
    if (pong.waitUntil(rt::now() + 20s))
      ++answered;
    else
      break;
  }
  EXPECT_EQ(answered, kRounds);
  if (answered < kRounds) ping.ring();
}

TEST(Doorbell, MakesVisibleWhatWasWrittenBeforeTheRing) {
  constexpr std::uint32_t kPerProducer = 20'000;
  constexpr std::size_t kProducers = 3;
  rt::Doorbell bell;
  std::vector<rt::SpscRing<std::uint32_t, 16>> rings(kProducers);
  std::vector<std::jthread> producers;
  producers.reserve(kProducers);
  for (std::size_t p = 0; p < kProducers; ++p) {
    producers.emplace_back([&, p] {
      for (std::uint32_t i = 0; i < kPerProducer; ++i) {
        while (!rings[p].tryPush(i)) std::this_thread::yield();
        bell.ring();
      }
    });
  }
  std::size_t received = 0;
  while (received < kProducers * kPerProducer) {
    ASSERT_TRUE(bell.waitUntil(rt::now() + 30s)) << "a wake-up was lost after " << received;
    for (auto& ring : rings) {
      while (ring.tryPop()) ++received;
    }
  }
}

}  // namespace
