// The panel on a real GPIO chip: contacts that bounce, the kernel's debounce, levels and lamps.

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "appliance/panel/panel_loop.h"
#include "hal/gpiod/panel.h"
#include "hal/gpiod/trigger_line.h"
#include "rt/periodic_loop.h"
#include "tests/conformance/button_panel_suite.h"
#include "tests/kernel/support/gpio_sim.h"
#include "tests/support/device_tree.h"
#include "tests/support/panel_gestures.h"

namespace test {
namespace {

using hal::Button;
using hal::Lamp;
using hal::gpiod::openButtonPanel;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::size_t kButtons = hal::kButtons.size();

std::string buttonLine(std::size_t button) {
  return "button-" + std::string(hal::kButtons.at(button).name);
}

std::vector<std::string> buttonLines() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kButtons; ++i) names.push_back(buttonLine(i));
  return names;
}

std::vector<std::string> allLines() {
  std::vector<std::string> names = buttonLines();
  for (const char* mode : {"live", "delayed", "frozen"})
    names.push_back(std::string("lamp-") + mode);
  return names;
}

/// A panel of our own making: buttons to ground, as on the box.
class SimPanel {
 public:
  explicit SimPanel(std::vector<std::string> lines = allLines()) : chip("panel", std::move(lines)) {
    for (std::size_t i = 0; i < kButtons; ++i) {
      try {
        const std::string path = chip.lineFolder(buttonLine(i)) + "/pull";
        pulls_.push_back(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
        contact(i, false);
      } catch (const std::runtime_error&) {
        pulls_.push_back(-1);  // a panel without that button
      }
    }
  }
  ~SimPanel() {
    for (const int fd : pulls_) ::close(fd);
  }
  SimPanel(const SimPanel&) = delete;
  SimPanel& operator=(const SimPanel&) = delete;

  void contact(std::size_t button, bool closed) const {
    const std::string_view level = closed ? "pull-down" : "pull-up";
    if (::pwrite(pulls_.at(button), level.data(), level.size(), 0) < 0)
      throw std::runtime_error("a contact cannot be moved");
  }
  void contact(Button button, bool closed) const {
    contact(static_cast<std::size_t>(button), closed);
  }
  [[nodiscard]] bool isLit(const char* mode) const {
    return chip.level(std::string("lamp-") + mode);
  }

  GpioSim chip;

 private:
  std::vector<int> pulls_;
};

hal::gpiod::OpenedPanel opened(std::chrono::milliseconds debounce = 10ms) {
  auto panel = openButtonPanel({.debounce = debounce});
  if (!panel) {
    ADD_FAILURE() << panel.error();
    return {};
  }
  return std::move(*panel);
}

OpenPanel withOnePressOfFreeze() {
  auto hardware = std::make_shared<SimPanel>();
  auto panel = opened();
  EXPECT_THAT(panel.notes, IsEmpty());
  std::thread([hardware] {
    std::this_thread::sleep_for(50ms);
    hardware->contact(Button::kFreeze, true);
    std::this_thread::sleep_for(100ms);
    hardware->contact(Button::kFreeze, false);
  }).detach();
  return {.hardware = hardware, .panel = std::move(panel.panel)};
}

INSTANTIATE_TEST_SUITE_P(Backends, ButtonPanelConformance,
                         testing::Values(PanelBackend{"Gpiod", withOnePressOfFreeze}),
                         [](const auto& backend) { return backend.param.name; });

TEST(GpioPanel, KnowsEveryButtonByItsLine) {
  const SimPanel sim;
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  for (std::size_t i = 0; i < kButtons; ++i) {
    for (const bool closed : {true, false}) {
      sim.contact(i, closed);
      const auto event = panel->waitEvent(1s);
      ASSERT_TRUE(event.has_value()) << hal::kButtons[i].name;
      EXPECT_EQ(event->button, static_cast<Button>(i));
      EXPECT_EQ(event->pressed, closed);
      EXPECT_EQ(panel->isPressed(static_cast<Button>(i)), closed);
    }
  }
  EXPECT_FALSE(panel->waitEvent(100ms));
}

TEST(GpioPanel, MakesOneEventOfATrainOfBounces) {
  const SimPanel sim;
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  for (const bool closed : {true, false}) {
    const rt::Timestamp begin = rt::now();
    for (int i = 0; i < 20; ++i) {
      sim.contact(Button::kSweep, i % 2 == 0 ? closed : !closed);
      std::this_thread::sleep_for(1ms);
    }
    sim.contact(Button::kSweep, closed);
    const auto event = panel->waitEvent(1s);
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->pressed, closed);
    EXPECT_GE(event->at, begin + 20ms) << "it came to rest only then";
    EXPECT_FALSE(panel->waitEvent(200ms));
  }
}

TEST(GpioPanel, IgnoresAPulseShorterThanTheDebounce) {
  const SimPanel sim;
  const auto panel = opened(50ms).panel;
  ASSERT_TRUE(panel);
  sim.contact(Button::kLive, true);
  std::this_thread::sleep_for(10ms);
  sim.contact(Button::kLive, false);
  EXPECT_FALSE(panel->waitEvent(500ms));
  EXPECT_FALSE(panel->isPressed(Button::kLive));
}

TEST(GpioPanel, ReportsChordsAsTheirPresses) {
  const SimPanel sim;
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  for (std::size_t i = 0; i < kButtons; ++i) sim.contact(i, true);
  std::vector<Button> pressed;
  while (const auto event = panel->waitEvent(200ms)) {
    EXPECT_TRUE(event->pressed);
    pressed.push_back(event->button);
  }
  EXPECT_EQ(pressed.size(), kButtons);
  for (std::size_t i = 0; i < kButtons; ++i) {
    EXPECT_THAT(pressed, Contains(static_cast<Button>(i)));
    EXPECT_TRUE(panel->isPressed(static_cast<Button>(i)));
  }
}

TEST(GpioPanel, NamesAButtonHeldAtBootAndReportsOnlyItsRelease) {
  const SimPanel sim;
  sim.contact(Button::kFreeze, true);
  const auto panel = opened();
  ASSERT_TRUE(panel.panel);
  EXPECT_THAT(panel.notes, Contains(HasSubstr("the button freeze is held down or stuck")));
  EXPECT_TRUE(panel.panel->isPressed(Button::kFreeze));
  EXPECT_FALSE(panel.panel->waitEvent(300ms)) << "it was not pressed";
  sim.contact(Button::kFreeze, false);
  const auto release = panel.panel->waitEvent(1s);
  ASSERT_TRUE(release.has_value());
  EXPECT_FALSE(release->pressed);
  sim.contact(Button::kFreeze, true);
  const auto press = panel.panel->waitEvent(1s);
  ASSERT_TRUE(press.has_value());
  EXPECT_TRUE(press->pressed);
}

TEST(GpioPanel, SwitchesEachLampAndLeavesAllDark) {
  const SimPanel sim;
  auto panel = opened().panel;
  ASSERT_TRUE(panel);
  const std::array<const char*, 3> names = {"live", "delayed", "frozen"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    panel->setLamp(static_cast<Lamp>(i), true);
    for (std::size_t j = 0; j < names.size(); ++j) EXPECT_EQ(sim.isLit(names.at(j)), i == j);
    panel->setLamp(static_cast<Lamp>(i), false);
  }
  panel->setLamp(Lamp::kDelayed, true);
  panel.reset();
  EXPECT_FALSE(sim.isLit("delayed"));
}

TEST(GpioPanel, WorksWithoutLampsAndSaysSo) {
  const SimPanel sim(buttonLines());
  const auto panel = opened();
  ASSERT_TRUE(panel.panel);
  EXPECT_THAT(panel.notes,
              testing::ElementsAre(AllOf(HasSubstr("lamp-live"), HasSubstr("stay off"))));
  panel.panel->setLamp(Lamp::kLive, true);
  sim.contact(Button::kLive, true);
  EXPECT_TRUE(panel.panel->waitEvent(1s).has_value());
  EXPECT_TRUE(panel.panel->alive());
}

TEST(GpioPanel, WorksWithSomeButtonsAndNamesTheOthers) {
  const SimPanel sim({"button-live", "button-freeze", "lamp-live", "lamp-delayed", "lamp-frozen"});
  const auto panel = opened();
  ASSERT_TRUE(panel.panel);
  EXPECT_THAT(panel.notes, testing::ElementsAre(AllOf(HasSubstr("\"button-sweep\""),
                                                      Not(HasSubstr("\"button-live\"")),
                                                      HasSubstr("these buttons are not there"))));
  EXPECT_FALSE(panel.panel->isPressed(Button::kSweep));
}

TEST(GpioPanel, WorksBehindAnExpanderAndSaysSo) {
  const SimPanel sim;
  const DeviceTree tree;
  tree.add("usb1/1-2", "usb");
  tree.addChip("usb1/1-2", std::filesystem::path(sim.chip.path()).filename());
  const auto panel = openButtonPanel({}, tree.root());
  ASSERT_TRUE(panel.has_value()) << panel.error();
  EXPECT_THAT(panel->notes,
              Contains(AllOf(HasSubstr("button-live"), HasSubstr("expander on the bus usb"))));
  sim.contact(Button::kLive, true);
  EXPECT_TRUE(panel->panel->waitEvent(1s).has_value());
}

TEST(GpioPanel, RefusesAPanelWithoutAnyButton) {
  const GpioSim chip("other", {"buttons-live", "lamp-live"});
  const auto panel = openButtonPanel({});
  ASSERT_FALSE(panel.has_value());
  EXPECT_THAT(panel.error(), AllOf(HasSubstr("no GPIO line is named \"button-live\""),
                                   HasSubstr("\"buttons-live\"")));
}

TEST(GpioPanel, RefusesALineThatSomebodyHolds) {
  const SimPanel sim;
  const auto holder = hal::gpiod::openTriggerLine({.lines = {"button-sweep"}});
  ASSERT_TRUE(holder) << holder.error();
  const auto panel = openButtonPanel({});
  ASSERT_FALSE(panel.has_value());
  EXPECT_THAT(panel.error(), HasSubstr("\"button-sweep\" on gpiochip0 is held by \"kagamid\""));
}

TEST(GpioPanel, IsGoneWithItsChipAndStaysSilent) {
  SimPanel sim;
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  sim.contact(Button::kLive, true);
  ASSERT_TRUE(panel->waitEvent(1s).has_value());
  sim.chip.remove();
  EXPECT_FALSE(panel->waitEvent(50ms));
  EXPECT_FALSE(panel->isPressed(Button::kLive)) << "it must not repeat forever";
  EXPECT_FALSE(panel->alive());
  panel->setLamp(Lamp::kLive, true);
  EXPECT_FALSE(panel->waitEvent(50ms));
}

TEST(GpioPanel, WorksWithButtonsAndLampsOnSeveralChips) {
  std::vector<std::string> here = buttonLines();
  std::vector<std::string> there(here.begin() + 5, here.end());
  here.resize(5);
  there.push_back("lamp-live");
  GpioSim one("one", here);
  GpioSim two("two", there);
  for (const std::string& line : here) one.pull(line, true);
  for (const std::string& line : there) two.pull(line, true);
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  two.pull("button-sweep", false);
  std::this_thread::sleep_for(50ms);
  one.pull("button-live", false);
  std::this_thread::sleep_for(50ms);
  const auto first = panel->waitEvent(1s);
  const auto second = panel->waitEvent(1s);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->button, Button::kSweep);
  EXPECT_EQ(second->button, Button::kLive);
  panel->setLamp(Lamp::kLive, true);
  EXPECT_TRUE(two.level("lamp-live"));
}

/// Everything a panel delivered on its way through.
class Listener final : public hal::ButtonPanel {
 public:
  explicit Listener(hal::ButtonPanel& panel) : panel_(panel) {}
  std::optional<hal::ButtonEvent> waitEvent(rt::Nanoseconds timeout) override {
    const auto event = panel_.waitEvent(timeout);
    if (event) events.push_back(*event);
    return event;
  }
  bool isPressed(Button button) override { return panel_.isPressed(button); }
  void setLamp(Lamp lamp, bool on) override { panel_.setLamp(lamp, on); }
  [[nodiscard]] bool alive() const override { return panel_.alive(); }

  std::vector<hal::ButtonEvent> events;

 private:
  hal::ButtonPanel& panel_;
};

/// A contact that closes or opens, with bounces, and comes to rest.
struct Change {
  std::size_t button = 0;
  bool closed = false;
  rt::Timestamp rest;  ///< when it stayed
};

/// Presses buttons at random, alone and together, each with a train of bounces; every button is
/// let go in the end.
std::vector<Change> pressAtRandom(const SimPanel& sim, int gestures) {
  std::mt19937 random(20);  // NOLINT(bugprone-random-generator-seed): the same run every time
  const auto upTo = [&](int most) { return std::uniform_int_distribution(0, most)(random); };
  std::vector<Change> changes;
  std::array<std::optional<rt::Timestamp>, kButtons> release_at{};
  std::array<rt::Timestamp, kButtons> rested{};
  rt::Timestamp now = rt::now();
  const auto change = [&](std::size_t button, bool closed) {
    const int bounces = upTo(3);
    for (int i = 0; i < bounces; ++i) {
      sim.contact(button, closed);
      rt::sleepUntil(now += std::chrono::microseconds(50 + upTo(1500)));
      sim.contact(button, !closed);
      rt::sleepUntil(now += std::chrono::microseconds(50 + upTo(1500)));
    }
    sim.contact(button, closed);
    changes.push_back({.button = button, .closed = closed, .rest = now});
    rested.at(button) = now;
  };
  const auto releaseDue = [&](rt::Timestamp until) {
    for (;;) {
      std::optional<std::size_t> next;
      for (std::size_t i = 0; i < kButtons; ++i)
        if (release_at.at(i) && *release_at.at(i) <= until &&
            (!next || *release_at.at(i) < *release_at.at(*next)))
          next = i;
      if (!next) return;
      now = std::max(now, *release_at.at(*next));
      rt::sleepUntil(now);
      release_at.at(*next).reset();
      change(*next, false);
    }
  };
  for (int made = 0; made < gestures;) {
    // A pause now and then, in which what is held goes on.
    const int pause_us = upTo(7) == 0 ? upTo(3'000'000) : upTo(150'000);
    const rt::Timestamp at = now + std::chrono::microseconds(1000 + pause_us);
    releaseDue(at);
    now = std::max(now, at);
    rt::sleepUntil(now);
    const auto button = static_cast<std::size_t>(upTo(static_cast<int>(kButtons) - 1));
    if (release_at.at(button) || now < rested.at(button) + 60ms) continue;
    change(button, true);
    // Mostly taps; now and then long enough to repeat or to go home.
    const int hold_ms = upTo(3) == 0 ? 400 + upTo(2500) : 60 + upTo(250);
    release_at.at(button) = now + std::chrono::milliseconds(hold_ms);
    ++made;
  }
  releaseDue(rt::Timestamp::max());
  return changes;
}

/// The gestures as the panel stamped them.
std::vector<Gesture> gesturesOf(const std::vector<hal::ButtonEvent>& events) {
  std::vector<Gesture> gestures;
  std::map<Button, Gesture> down;
  for (const hal::ButtonEvent& event : events) {
    if (event.pressed) {
      down[event.button] = {.button = event.button, .press = event.at};
    } else if (const auto of = down.extract(event.button)) {
      gestures.push_back(of.mapped());
      gestures.back().release = event.at;
    }
  }
  EXPECT_TRUE(down.empty()) << "a button is stuck";
  return gestures;
}

/// The kernel's debounce ends with one of its ticks, and a repetition may be due at the same one:
/// then it may come or not. Takes those out.
void withoutTies(std::vector<Expected>& commands, const std::vector<hal::ButtonEvent>& events) {
  std::erase_if(commands, [&](const Expected& command) {
    const auto next = std::ranges::lower_bound(events, command.cause, {}, &hal::ButtonEvent::at);
    return next != events.end() && next->at > command.cause && next->at < command.cause + 10us;
  });
}

TEST(GpioPanel, GivesOneEventForEachOf10000BouncingPressesAndTheCommandsOfTheManual) {
  constexpr int kGestures = 10'000;
  const SimPanel sim;
  const auto panel = opened().panel;
  ASSERT_TRUE(panel);
  Listener listener(*panel);
  std::vector<Expected> given;
  appliance::PanelLoop loop(
      listener,
      [&](const appliance::PanelCommand& command) {
        given.push_back({command.cause, command.command.kind});
      },
      [] { return appliance::Mode::kLive; });
  std::vector<Change> changes;
  {
    const std::jthread thread([&](const std::stop_token& stop) { loop.run(stop); });
    changes = pressAtRandom(sim, kGestures);
    std::this_thread::sleep_for(3s);
  }
  // Every change of a contact is one event, of the right button and in the right sense, stamped
  // when the debounce was over.
  ASSERT_EQ(changes.size(), 2U * kGestures);
  ASSERT_EQ(listener.events.size(), changes.size());
  std::array<std::vector<Change>, kButtons> of_button;
  for (const Change& change : changes) of_button.at(change.button).push_back(change);
  std::array<std::size_t, kButtons> seen{};
  for (const hal::ButtonEvent& event : listener.events) {
    const auto button = static_cast<std::size_t>(event.button);
    const Change& change = of_button.at(button).at(seen.at(button)++);
    ASSERT_EQ(event.pressed, change.closed) << hal::kButtons.at(button).name;
    ASSERT_GE(event.at, change.rest) << hal::kButtons.at(button).name;
    ASSERT_LE(event.at, change.rest + 50ms) << hal::kButtons.at(button).name;
  }
  for (std::size_t i = 0; i < kButtons; ++i) EXPECT_FALSE(panel->isPressed(static_cast<Button>(i)));
  std::ranges::sort(given);
  auto expected = manualSays(gesturesOf(listener.events));
  EXPECT_GT(expected.size(), 1U * kGestures);
  EXPECT_TRUE(std::ranges::count(expected, appliance::Command::Kind::kHome, &Expected::kind) > 10);
  std::printf("%zu commands of %d presses\n", given.size(), kGestures);
  withoutTies(given, listener.events);
  withoutTies(expected, listener.events);
  ASSERT_EQ(given.size(), expected.size());
  EXPECT_TRUE(given == expected);
}

}  // namespace
}  // namespace test
