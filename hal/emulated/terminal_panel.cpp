#include "hal/emulated/terminal_panel.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include <poll.h>
#include <unistd.h>

namespace hal::emulated {
namespace {

struct Key {
  char key;
  Button button;
};

constexpr std::array<Key, 11> kKeyTable = {{{'l', Button::kLive},
                                            {' ', Button::kFreeze},
                                            {'f', Button::kFreeze},
                                            {'-', Button::kDelayLess},
                                            {'+', Button::kDelayMore},
                                            {',', Button::kStepBack},
                                            {'.', Button::kStepForward},
                                            {'a', Button::kViewLeft},
                                            {'d', Button::kViewRight},
                                            {'s', Button::kSweep},
                                            {'v', Button::kSpeed}}};

std::optional<Button> buttonOf(char key) {
  const auto* found = std::ranges::find(kKeyTable, key, &Key::key);
  if (found == kKeyTable.end()) return std::nullopt;
  return found->button;
}

constexpr char kKeys[] =
    "keys: l live   space freeze   - + delay   , . step in time   a d view   s sweep   v speed   "
    "^C end\n";

}  // namespace

std::expected<std::unique_ptr<ButtonPanel>, std::string> TerminalPanel::open() {
  termios before{};
  if (tcgetattr(STDIN_FILENO, &before) != 0) {
    return std::unexpected(
        "panel \"terminal\": standard input is not a terminal: start it from one, or use "
        "panel.backend = \"scripted\"");
  }
  termios keys = before;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  std::fputs(kKeys, stderr);
  return std::unique_ptr<ButtonPanel>{new TerminalPanel(before)};
}

TerminalPanel::~TerminalPanel() {
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<ButtonEvent> TerminalPanel::waitEvent(rt::Nanoseconds timeout) {
  if (pressed_) {
    const ButtonEvent release{*pressed_, false, rt::now()};
    pressed_.reset();
    return release;
  }
  pressed_ = readKey(timeout);
  if (!pressed_) return std::nullopt;
  return ButtonEvent{*pressed_, true, rt::now()};
}

std::optional<Button> TerminalPanel::readKey(rt::Nanoseconds timeout) {
  if (!alive_) {
    std::this_thread::sleep_for(timeout);
    return std::nullopt;
  }
  pollfd input{STDIN_FILENO, POLLIN, 0};
  const auto timeout_ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  if (poll(&input, 1, static_cast<int>(std::max<std::int64_t>(0, timeout_ms))) <= 0) {
    return std::nullopt;
  }
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) {
    alive_ = false;  // the terminal is gone
    return std::nullopt;
  }
  return buttonOf(key);
}

}  // namespace hal::emulated
