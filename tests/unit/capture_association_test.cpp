#include <memory>

#include <gtest/gtest.h>

#include "appliance/capture/association.h"

namespace {

using namespace std::chrono_literals;
using appliance::Association;
using appliance::EdgeBoard;

constexpr rt::Nanoseconds kPeriod = 25ms;
constexpr rt::Nanoseconds kDelay = 1ms;

class AssociationTest : public testing::Test {
 protected:
  AssociationTest() {
    for (std::uint64_t trigger = 1; trigger <= 100; ++trigger) edges_->post(trigger, edge(trigger));
  }
  static rt::Timestamp edge(std::uint64_t trigger) {
    return rt::fromNs(1'000'000'000) + static_cast<std::int64_t>(trigger) * kPeriod;
  }
  std::unique_ptr<EdgeBoard> edges_ = std::make_unique<EdgeBoard>();
  Association association_{kPeriod, kDelay};
};

TEST_F(AssociationTest, NamesTheEdgeOneCameraDelayBeforeTheLeader) {
  EXPECT_EQ(association_.triggerOf(edge(100) + kDelay, *edges_), 100U);
  EXPECT_EQ(association_.triggerOf(edge(80) + kDelay, *edges_), 80U);
}

TEST_F(AssociationTest, FollowsALeaderThatIsLateByLessThanHalfAPeriod) {
  EXPECT_EQ(association_.triggerOf(edge(99) + kDelay + 12ms, *edges_), 99U);
  EXPECT_EQ(association_.triggerOf(edge(99) + kDelay - 12ms, *edges_), 99U);
}

TEST_F(AssociationTest, NamesNobodyExactlyBetweenTwoEdges) {
  EXPECT_EQ(association_.triggerOf(edge(98) + kDelay + kPeriod / 2, *edges_), std::nullopt);
}

TEST_F(AssociationTest, NamesNobodyLongAfterTheLastEdge) {
  EXPECT_EQ(association_.triggerOf(edge(100) + kDelay + 13ms, *edges_), std::nullopt);
  EXPECT_EQ(association_.triggerOf(edge(100) + 10s, *edges_), std::nullopt);
}

TEST_F(AssociationTest, NamesNobodyBeforeTheFirstEdge) {
  const EdgeBoard empty;
  EXPECT_EQ(association_.triggerOf(edge(1), empty), std::nullopt);
  EXPECT_EQ(association_.triggerOf(edge(1) - 13ms, *edges_), std::nullopt);
}

TEST_F(AssociationTest, RepairsASlipOfOneTriggerByTimeAlone) {
  // The camera ignored trigger 90: its next frame is that of 91, whatever its frame id says.
  EXPECT_EQ(association_.triggerOf(edge(89) + kDelay, *edges_), 89U);
  EXPECT_EQ(association_.triggerOf(edge(91) + kDelay, *edges_), 91U);
}

}  // namespace
