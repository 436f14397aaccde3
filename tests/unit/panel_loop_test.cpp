#include "appliance/panel/panel_loop.h"

#include <array>
#include <deque>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using appliance::Command;
using appliance::Mode;
using appliance::PanelCommand;
using appliance::PanelLoop;
using hal::Button;
using hal::Lamp;

/// Delivers its events one after the other, then ends the loop.
class ListedPanel final : public hal::ButtonPanel {
 public:
  std::optional<hal::ButtonEvent> waitEvent(rt::Nanoseconds /*timeout*/) override {
    if (events.empty()) {
      stop.request_stop();
      return std::nullopt;
    }
    const hal::ButtonEvent event = events.front();
    events.pop_front();
    return event;
  }
  bool isPressed(Button /*button*/) override { return false; }
  void setLamp(Lamp lamp, bool on) override { lit.at(static_cast<std::size_t>(lamp)) = on; }
  [[nodiscard]] bool alive() const override { return is_alive; }

  std::deque<hal::ButtonEvent> events;
  std::stop_source stop;
  std::array<bool, 3> lit{};
  bool is_alive = true;
};

struct Carried {
  std::vector<PanelCommand> commands;
  bool lost = false;
};

Carried carry(ListedPanel& panel, Mode mode) {
  Carried carried;
  PanelLoop loop(
      panel, [&](const PanelCommand& command) { carried.commands.push_back(command); },
      [mode] { return mode; });
  loop.run(panel.stop.get_token());
  carried.lost = loop.lost();
  return carried;
}

TEST(PanelLoop, CarriesPressesOnWithTheInstantOfTheContact) {
  ListedPanel panel;
  const rt::Timestamp at = rt::now();
  panel.events = {{Button::kFreeze, true, at}, {Button::kFreeze, false, at + 1ms}};
  const Carried carried = carry(panel, Mode::kLive);
  ASSERT_EQ(carried.commands.size(), 1U);
  EXPECT_EQ(carried.commands[0].command.kind, Command::Kind::kFreezeToggle);
  EXPECT_EQ(carried.commands[0].cause, at);
  EXPECT_FALSE(carried.lost);
}

TEST(PanelLoop, LightsTheLampOfTheModeAndNoOther) {
  for (const auto& [mode, lit] : {std::pair{Mode::kLive, std::array{true, false, false}},
                                  std::pair{Mode::kDelayed, std::array{false, true, false}},
                                  std::pair{Mode::kSweep, std::array{false, false, true}}}) {
    ListedPanel panel;
    panel.lit = {true, true, true};
    (void)carry(panel, mode);
    EXPECT_EQ(panel.lit, lit);
  }
}

TEST(PanelLoop, SaysThatThePanelIsGone) {
  ListedPanel panel;
  panel.is_alive = false;
  EXPECT_TRUE(carry(panel, Mode::kLive).lost);
}

}  // namespace
