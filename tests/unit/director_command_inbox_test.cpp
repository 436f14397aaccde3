#include <gtest/gtest.h>

#include "appliance/director/command_inbox.h"

namespace {

using appliance::Command;
using appliance::CommandInbox;
using appliance::CommandSender;
using appliance::kMostCommands;

constexpr Command kFreeze{Command::Kind::kFreezeToggle};
constexpr Command kSweep{Command::Kind::kSweep};

TEST(CommandInbox, DeliversEachSendersCommandsInOrderWithTheirInstants) {
  rt::Doorbell bell;
  CommandInbox inbox(bell);
  CommandSender& panel = inbox.open("panel");
  CommandSender& control = inbox.open("control");
  EXPECT_TRUE(control.give({kSweep, rt::fromNs(1)}));
  EXPECT_TRUE(panel.give({kFreeze, rt::fromNs(2)}));
  EXPECT_TRUE(panel.give({kSweep, rt::fromNs(3)}));
  for (const auto& [command, at_ns] : {std::pair{kFreeze, 2}, {kSweep, 3}, {kSweep, 1}}) {
    const auto event = inbox.tryTake();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->command, command);
    EXPECT_EQ(rt::toNs(event->at), at_ns);
  }
  EXPECT_FALSE(inbox.tryTake().has_value());
}

TEST(CommandInbox, RingsTheBellForEveryCommand) {
  rt::Doorbell bell;
  CommandInbox inbox(bell);
  CommandSender& panel = inbox.open("panel");
  EXPECT_FALSE(bell.waitUntil(rt::now()));
  (void)panel.give({kFreeze, rt::now()});
  EXPECT_TRUE(bell.waitUntil(rt::now()));
}

TEST(CommandInbox, RefusesTheNewestWhenASenderIsFullAndCountsItForThatSenderOnly) {
  rt::Doorbell bell;
  CommandInbox inbox(bell);
  CommandSender& panel = inbox.open("panel");
  CommandSender& control = inbox.open("control");
  for (std::uint32_t i = 0; i < kMostCommands; ++i)
    ASSERT_TRUE(panel.give({kFreeze, rt::fromNs(i)}));
  EXPECT_FALSE(panel.give({kSweep, rt::fromNs(1000)}));
  EXPECT_TRUE(control.give({kSweep, rt::fromNs(1001)}));
  EXPECT_EQ(panel.refused(), 1U);
  EXPECT_EQ(control.refused(), 0U);
  EXPECT_EQ(inbox.senders().at(0)->name(), "panel");
  std::uint32_t taken = 0;
  while (inbox.tryTake()) ++taken;
  EXPECT_EQ(taken, kMostCommands + 1);
}

}  // namespace
