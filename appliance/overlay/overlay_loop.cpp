#include "appliance/overlay/overlay_loop.h"

#include <chrono>
#include <utility>

#include "appliance/overlay/status_overlay.h"
#include "rt/clock.h"

namespace appliance {

void OverlayLoop::run(const std::stop_token& stop) {
  constexpr rt::Nanoseconds kPatience = std::chrono::milliseconds(200);  // a stop rings no bell
  while (!stop.stop_requested()) {
    (void)board_.subject_changed.waitUntil(rt::now() + kPatience);
    if (const auto subject = board_.subject.tryTake()) follow(*subject);
  }
}

void OverlayLoop::follow(const OverlaySubject& subject) {
  StatusText status = statusText(subject.shot, subject.cameras);
  const bool same = status.text == said_.text && status.warning == said_.warning &&
                    subject.width_px == width_px_ && subject.height_px == height_px_;
  if (same && overlay_->refused == 0) return;
  said_ = std::move(status);
  width_px_ = subject.width_px;
  height_px_ = subject.height_px;
  typesetter_.begin(*overlay_);
  addStatusLine(said_, width_px_, height_px_, typesetter_, *overlay_);
  typesetter_.finish(*overlay_);
  board_.overlay.publish(*overlay_);
  if (std::string warning = typesetter_.takeWarning(); !warning.empty()) {
    const std::lock_guard lock(warning_mutex_);
    warning_ = std::move(warning);
  }
}

std::string OverlayLoop::warning() const {
  const std::lock_guard lock(warning_mutex_);
  return warning_;
}

}  // namespace appliance
