// What the control interface asks of the box: its half of ControlSink.

#include <string>
#include <utility>
#include <vector>

#include "appliance/box/box.h"
#include "appliance/geometry/rig_file.h"
#include "appliance/metrics/metrics_text.h"

namespace appliance {

std::optional<CommandId> Box::command(const Command& command) {
  const CommandId id = ++last_command_;
  if (!control_commands_.give({.command = command, .at = rt::now(), .id = id})) return std::nullopt;
  return id;
}

std::optional<CommandAnswer> Box::nextAnswer() {
  return commands_.answers().tryTake();
}

std::string Box::metrics() const {
  return toJson(metrics_.snapshot());
}

/// A target that a person sets holds from the moment that is on the screen.
rt::Timestamp Box::shownExposure() const {
  const rt::Timestamp shown = shown_.exposure_middle.load(std::memory_order_relaxed);
  return shown == rt::Timestamp{} ? rt::now() : shown;
}

bool Box::setTarget(const std::array<double, 3>& target_m) {
  target_.setByHand({target_m[0], target_m[1], target_m[2]}, shownExposure());
  board_.wake_render.ring();
  return true;
}

void Box::releaseTarget() {
  target_.release(shownExposure());
  board_.wake_render.ring();
}

std::expected<std::vector<std::string>, Phrase> Box::loadRig(const std::string& text,
                                                             const std::string& name) {
  auto rig = parseRig(text, name, site_.config.cameras.pixel_format);
  if (!rig) return std::unexpected(phrase<Word::kRigRefused>(rig.error()));
  std::vector<std::string> warnings = rig->warnings;
  if (const auto put = rigs_.put(std::move(*rig)); !put) return std::unexpected(put.error());
  board_.wake_render.ring();
  return warnings;
}

void Box::setScreenReleased(bool released) {
  (void)parts_.handle({.verb = released ? "screen.release" : "screen.take"});
}

}  // namespace appliance
