#include <gtest/gtest.h>

#include "hal/emulated/scripted_panel.h"

namespace {

using namespace hal::emulated;  // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;

TEST(PanelScript, ReadsChangesInOrderOfTime) {
  const auto changes = parsePanelScript(
      "# what a coach does\n"
      "2 release freeze   # lets go\n"
      "\n"
      "1.5 press freeze\n"
      "0.25 tap live\n",
      "script");
  ASSERT_TRUE(changes) << changes.error();
  const std::vector<ScriptedChange> expected = {{250ms, hal::Button::kLive, true},
                                                {250ms + kTap, hal::Button::kLive, false},
                                                {1500ms, hal::Button::kFreeze, true},
                                                {2s, hal::Button::kFreeze, false}};
  EXPECT_EQ(*changes, expected);
}

TEST(PanelScript, NamesTheLineThatMakesNoSense) {
  const struct {
    const char* text;
    const char* complaint;
  } cases[] = {
      {"1 tap live\nsoon tap live\n", "p.txt:2: 'soon' is not a time"},
      {"-1 tap live\n", "p.txt:1: '-1' is not a time"},
      {"nan tap live\n", "p.txt:1: 'nan' is not a time"},
      {"1 push live\n", "p.txt:1: 'push' is not press, release or tap"},
      {"1 tap play\n", "p.txt:1: 'play' is not a button; they are: live, freeze"},
      {"1\n", "p.txt:1: '' is not press"},
      {"1 tap live twice\n", "p.txt:1: 'twice' stands after the button"},
  };
  for (const auto& c : cases) {
    const auto changes = parsePanelScript(c.text, "p.txt");
    ASSERT_FALSE(changes) << c.text;
    EXPECT_EQ(changes.error().substr(0, std::string(c.complaint).size()), c.complaint);
  }
}

TEST(ScriptedPanel, NamesAScriptThatIsNotThere) {
  const auto panel = ScriptedPanel::open("/nonexistent/script", rt::now());
  ASSERT_FALSE(panel);
  EXPECT_NE(panel.error().find("/nonexistent/script"), std::string::npos);
}

TEST(ScriptedPanel, StampsEventsWithTheScriptedInstant) {
  const rt::Timestamp start = rt::now() - 10s;  // fetched late on purpose
  ScriptedPanel panel({{1s, hal::Button::kSweep, true}}, start);
  const auto event = panel.waitEvent(0ns);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->at, start + 1s);
}

TEST(ScriptedPanel, RemembersItsLamps) {
  ScriptedPanel panel({}, rt::now());
  panel.setLamp(hal::Lamp::kFrozen, true);
  panel.setLamp(hal::Lamp::kLive, true);
  panel.setLamp(hal::Lamp::kFrozen, false);
  EXPECT_FALSE(panel.isLit(hal::Lamp::kFrozen));
  EXPECT_TRUE(panel.isLit(hal::Lamp::kLive));
  EXPECT_EQ(panel.lampChanges().size(), 3u);
}

}  // namespace
