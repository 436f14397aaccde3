#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "appliance/capture/edge_board.h"

namespace {

using appliance::EdgeBoard;

TEST(EdgeBoard, HasNoEdgeBeforeTheFirstTrigger) {
  const auto board = std::make_unique<EdgeBoard>();
  EXPECT_EQ(board->newest(), 0U);
  EXPECT_EQ(board->edge(0), rt::Timestamp{});
  EXPECT_EQ(board->edge(1), rt::Timestamp{});
}

TEST(EdgeBoard, GivesEveryRecentEdgeAndForgetsOverwrittenOnes) {
  const auto board = std::make_unique<EdgeBoard>();
  for (std::uint64_t trigger = 1; trigger <= 1500; ++trigger) {
    board->post(trigger, rt::fromNs(static_cast<std::int64_t>(trigger) * 1000));
  }
  EXPECT_EQ(board->newest(), 1500U);
  EXPECT_EQ(board->edge(1500), rt::fromNs(1'500'000));
  EXPECT_EQ(board->edge(1500 - 1023), rt::fromNs(477'000));
  EXPECT_EQ(board->edge(1500 - 1024), rt::Timestamp{}) << "its place serves trigger 1500 now";
}

TEST(EdgeBoard, NeverPairsAnIdWithAnotherTriggersEdge) {
  const auto board = std::make_unique<EdgeBoard>();
  constexpr std::uint64_t kTriggers = 200'000;
  std::jthread writer([&] {
    for (std::uint64_t trigger = 1; trigger <= kTriggers; ++trigger) {
      board->post(trigger, rt::fromNs(static_cast<std::int64_t>(trigger)));
    }
  });
  std::uint64_t wrong = 0;
  while (board->newest() < kTriggers) {
    const std::uint64_t newest = board->newest();
    for (const std::uint64_t back : {0ULL, 1ULL, 1022ULL, 1023ULL}) {
      if (back >= newest) continue;
      const rt::Timestamp edge = board->edge(newest - back);
      if (edge != rt::Timestamp{} && edge != rt::fromNs(static_cast<std::int64_t>(newest - back))) {
        ++wrong;
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
