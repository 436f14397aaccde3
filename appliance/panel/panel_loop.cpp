#include "appliance/panel/panel_loop.h"

#include <algorithm>
#include <utility>

#include "appliance/panel/lamps.h"

namespace appliance {
namespace {

constexpr rt::Nanoseconds kPoll = std::chrono::milliseconds(20);  // of the mode, and of the end

}  // namespace

PanelLoop::PanelLoop(hal::ButtonPanel& panel, Give give, ModeNow mode)
    : panel_(panel),
      give_(std::move(give)),
      mode_(std::move(mode)),
      controller_([this](hal::Button button) { return panel_.isPressed(button); }) {}

void PanelLoop::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) turn();
}

void PanelLoop::turn() {
  const rt::Timestamp now = rt::now();
  const rt::Timestamp wake = std::min(controller_.nextTime().value_or(now + kPoll), now + kPoll);
  if (const auto event = panel_.waitEvent(std::max(wake - now, rt::Nanoseconds{0}))) {
    if (const auto command = controller_.onEvent(*event)) give_(*command);
  }
  if (const auto command = controller_.onTime(rt::now())) give_(*command);
  followMode();
  lost_.store(!panel_.alive(), std::memory_order_relaxed);
}

void PanelLoop::followMode() {
  const hal::Lamp wanted = lampOf(mode_());
  if (lit_ == wanted) return;
  for (const hal::Lamp lamp : {hal::Lamp::kLive, hal::Lamp::kDelayed, hal::Lamp::kFrozen}) {
    panel_.setLamp(lamp, lamp == wanted);
  }
  lit_ = wanted;
}

}  // namespace appliance
