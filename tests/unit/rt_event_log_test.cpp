#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rt/event_log.h"

namespace {

using rt::fromNs;

enum class Kind : std::uint8_t { kOverrun = 1, kFrameLost = 2 };

std::vector<std::int64_t> firstArgs(const std::vector<rt::Event>& events) {
  std::vector<std::int64_t> args;
  args.reserve(events.size());
  for (const auto& event : events) args.push_back(event.args[0]);
  return args;
}

TEST(EventLog, BringsTheEventsOfAllProducersTogetherByTime) {
  rt::EventLog log;
  auto& capture = log.addProducer("capture");
  auto& render = log.addProducer("render");
  render.post(Kind::kOverrun, fromNs(30), {3});
  capture.post(Kind::kFrameLost, fromNs(10), {1, 7});
  capture.post(Kind::kOverrun, fromNs(40), {4});
  render.post(Kind::kOverrun, fromNs(40), {5});

  const auto events = log.drain();
  EXPECT_THAT(firstArgs(events), testing::ElementsAre(1, 3, 4, 5));
  EXPECT_EQ(events[0].kind, static_cast<std::uint32_t>(Kind::kFrameLost));
  EXPECT_EQ(events[0].at, fromNs(10));
  EXPECT_EQ(events[0].args[1], 7);
  EXPECT_EQ(log.producer(events[0].producer).name(), "capture");
  EXPECT_EQ(log.producer(events[1].producer).name(), "render");
  EXPECT_TRUE(log.drain().empty());
}

TEST(EventLog, KeepsTheOldestEventsWhenFullAndCountsTheLoss) {
  rt::EventLog log;
  auto& producer = log.addProducer("capture");
  for (int i = 0; i < 2000; ++i) producer.post(Kind::kOverrun, fromNs(i), {i});
  const auto events = log.drain();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().args[0] + 1, static_cast<std::int64_t>(events.size()));
  EXPECT_EQ(log.lost() + events.size(), 2000u);
  EXPECT_EQ(producer.lost(), log.lost());
}

TEST(EventLog, AccountsForEveryEventWhileThreadsPostAndTheDrainRuns) {
  constexpr std::int64_t kEvents = 20'000;
  constexpr std::size_t kProducers = 3;
  rt::EventLog log;
  std::vector<std::jthread> threads;
  for (std::size_t p = 0; p < kProducers; ++p) {
    auto& producer = log.addProducer("p" + std::to_string(p));
    threads.emplace_back([&producer] {
      for (std::int64_t i = 0; i < kEvents; ++i) producer.post(Kind::kOverrun, rt::now(), {i});
    });
  }
  std::vector<std::int64_t> last(kProducers, -1);
  std::uint64_t received = 0;
  bool in_order = true;
  const auto take = [&] {
    for (const auto& event : log.drain()) {
      in_order = in_order && event.args[0] > last[event.producer];
      last[event.producer] = event.args[0];
      ++received;
    }
  };
  for (int i = 0; i < 100; ++i) take();
  threads.clear();
  take();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(received + log.lost(), kProducers * kEvents);
}

}  // namespace
