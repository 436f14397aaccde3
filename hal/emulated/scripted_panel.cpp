#include "hal/emulated/scripted_panel.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

#include "rt/printable.h"

namespace hal::emulated {
namespace {

constexpr double kLongestScript_s = 1e6;
constexpr rt::Nanoseconds kLongestWait = std::chrono::hours(24 * 365);  // adding it cannot overflow

void sleepUntil(rt::Timestamp t) {
  const std::int64_t ns = rt::toNs(t);
  const timespec until{ns / 1'000'000'000, ns % 1'000'000'000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::optional<Button> findButton(std::string_view name) {
  const auto* found = std::ranges::find(kButtons, name, &ButtonRow::name);
  if (found == kButtons.end()) return std::nullopt;
  return found->button;
}

std::string buttonList() {
  std::string list;
  for (const ButtonRow& row : kButtons) list += (list.empty() ? "" : ", ") + std::string(row.name);
  return list;
}

std::expected<void, std::string> parseLine(const std::string& line,
                                           std::vector<ScriptedChange>& changes) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string time;
  std::string verb;
  std::string name;
  std::string rest;
  if (!(words >> time)) return {};
  words >> verb >> name;
  char* end = nullptr;
  const double seconds = std::strtod(time.c_str(), &end);
  if (*end != '\0' || !(seconds >= 0 && seconds <= kLongestScript_s)) {
    return std::unexpected("'" + time + "' is not a time in seconds since the start");
  }
  if (verb != "press" && verb != "release" && verb != "tap") {
    return std::unexpected("'" + verb + "' is not press, release or tap");
  }
  const auto button = findButton(name);
  if (!button) {
    return std::unexpected("'" + name + "' is not a button; they are: " + buttonList());
  }
  if (words >> rest) return std::unexpected("'" + rest + "' stands after the button");
  const rt::Nanoseconds after{std::llround(seconds * 1e9)};
  changes.push_back({after, *button, verb != "release"});
  if (verb == "tap") changes.push_back({after + kTap, *button, false});
  return {};
}

}  // namespace

std::expected<std::vector<ScriptedChange>, std::string> parsePanelScript(std::string_view text,
                                                                         std::string_view origin) {
  std::vector<ScriptedChange> changes;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (auto parsed = parseLine(line, changes); !parsed) {
      return std::unexpected(std::string(origin) + ":" + std::to_string(number) + ": " +
                             rt::printable(parsed.error()));
    }
  }
  std::ranges::stable_sort(changes, {}, &ScriptedChange::after);
  return changes;
}

std::expected<ScriptedPanel, std::string> ScriptedPanel::open(const std::filesystem::path& script,
                                                              rt::Timestamp start) {
  std::ifstream file(script);
  if (!file) {
    return std::unexpected("cannot read the panel script " + script.string() + ": " +
                           std::strerror(errno));
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto changes = parsePanelScript(text, script.string());
  if (!changes) return std::unexpected(changes.error());
  return ScriptedPanel(std::move(*changes), start);
}

ScriptedPanel::ScriptedPanel(std::vector<ScriptedChange> changes, rt::Timestamp start)
    : changes_(std::move(changes)), start_(start) {}

std::optional<ButtonEvent> ScriptedPanel::waitEvent(rt::Nanoseconds timeout) {
  const rt::Timestamp give_up = rt::now() + std::clamp(timeout, rt::Nanoseconds{0}, kLongestWait);
  if (next_ == changes_.size() || start_ + changes_[next_].after > give_up) {
    sleepUntil(give_up);
    return std::nullopt;
  }
  const ScriptedChange& change = changes_[next_++];
  const rt::Timestamp at = start_ + change.after;
  sleepUntil(at);
  return ButtonEvent{change.button, change.pressed, at};
}

bool ScriptedPanel::isPressed(Button button) {
  const rt::Nanoseconds elapsed = rt::now() - start_;
  bool pressed = false;
  for (const ScriptedChange& change : changes_) {
    if (change.after > elapsed) break;
    if (change.button == button) pressed = change.pressed;
  }
  return pressed;
}

void ScriptedPanel::setLamp(Lamp lamp, bool on) {
  lamp_changes_.push_back({lamp, on, rt::now()});
}

bool ScriptedPanel::isLit(Lamp lamp) const {
  bool lit = false;
  for (const LampChange& change : lamp_changes_) {
    if (change.lamp == lamp) lit = change.on;
  }
  return lit;
}

}  // namespace hal::emulated
