#include "ui-kms/kms/screen.h"

#include <cerrno>
#include <utility>

namespace ui::kms {

using What = hal::ScreenTrouble;

std::expected<std::unique_ptr<Screen>, std::string> Screen::open(const ScreenConfig& config) {
  auto device = Device::open(config.device);
  if (!device) return std::unexpected(device.error());
  std::unique_ptr<Screen> screen(new Screen(config, std::move(*device), rt::now()));
  screen->attend(rt::now());
  return screen;
}

void Screen::attend(rt::Timestamp now) {
  if (hotplug_.heard()) machine_.onHotplug();
  while (true) {
    switch (machine_.next(now)) {
      case ScreenMachine::Task::kNone:
        return;
      case ScreenMachine::Task::kTakeMaster: {
        const auto taken = device_->tryTakeMaster();
        trouble_ = {};
        if (!taken)
          trouble_ = {taken.error() == EBUSY ? What::kCardInUse : What::kCardNotPermitted,
                      device_->path()};
        machine_.onMaster(taken.has_value(), now);
        break;
      }
      case ScreenMachine::Task::kLook:
        look(now);
        break;
      case ScreenMachine::Task::kGlance:
        glance(now);
        break;
    }
  }
}

/// The screen that is lit as long as it is there, otherwise any.
std::optional<Connector> Screen::seek() const {
  if (output_) {
    auto same = readConnector(device_->fd(), output_->connector().id, Probe::kSearch);
    if (same && same->connected && !same->modes.empty()) return same;
  }
  return findConnector(device_->fd(), Probe::kSearch);
}

void Screen::look(rt::Timestamp now) {
  auto connector = seek();
  const bool same_connector = output_ && connector && output_->connector().id == connector->id;
  if (output_ && !same_connector) leaveOutput();
  if (!connector) {
    trouble_ = {What::kNothingConnected, device_->path()};
    machine_.onLook({.usable = false}, now);
    return;
  }
  auto output = Output::find(device_->fd(), *connector);
  const auto mode = output ? firstPossible(*output) : std::nullopt;
  if (!mode) {
    trouble_ = {!output                    ? What::kNoCrtc
                : connector->modes.empty() ? What::kNoMode
                                           : What::kModesRefused,
                connector->name};
    leaveOutput();
    machine_.onLook({.usable = false}, now);
    return;
  }
  const bool unchanged = same_connector && mode_ && sameTiming(*mode_, *mode);
  mode_ = *mode;
  output_ = std::move(*output);
  trouble_ = {};
  if (config_.mode && !fulfils(*mode, *config_.mode))
    trouble_ = {What::kOtherMode, connector->name, describe(*mode)};
  machine_.onLook({.usable = true, .unchanged = unchanged, .link_good = connector->linkGood()},
                  now);
}

/// The best of the screen's modes that the driver says it can set. The mode that is lit is not
/// asked for.
std::optional<drmModeModeInfo> Screen::firstPossible(const Output& output) const {
  for (const drmModeModeInfo& mode :
       rankModes(output.connector().modes, config_.trigger_hz, config_.mode)) {
    if ((takesPictures() && mode_ && sameTiming(*mode_, mode)) || output.tryLight(mode)) {
      return mode;
    }
  }
  return std::nullopt;
}

void Screen::glance(rt::Timestamp now) {
  const auto known =
      output_ ? readConnector(device_->fd(), output_->connector().id, Probe::kKnown) : std::nullopt;
  machine_.onGlance(known && known->connected && known->linkGood(), now);
}

/// A screen that comes back must be lit from darkness, so that its link is trained.
void Screen::leaveOutput() {
  if (output_ && machine_.master()) static_cast<void>(output_->darken());
  output_.reset();
}

void Screen::readFlips(std::vector<FlipEvent>& flips) {
  const std::size_t before = flips.size();
  device_->readFlips(flips);
  if (flips.size() != before) machine_.onFlip();
}

rt::Result<void> Screen::show(std::uint32_t framebuffer, int fence, std::uint64_t serial,
                              rt::Timestamp now) {
  if (!takesPictures() || !output_ || !mode_) {
    return std::unexpected(rt::Error{rt::Errc::kDeviceLost, 0, "commit: no screen"});
  }
  const auto done = machine_.state() == ScreenMachine::State::kLighting
                        ? output_->light(*mode_, framebuffer, fence, serial)
                        : output_->flip(framebuffer, fence, serial);
  if (!done) return std::unexpected(onFailure(done.error(), now));
  machine_.onCommitted(now);
  return {};
}

rt::Error Screen::onFailure(int error, rt::Timestamp now) {
  switch (error) {
    case EBUSY:
      return {rt::Errc::kBusy, error, "commit: the last one has not flipped yet"};
    case EACCES:
    case EPERM:
      machine_.onMasterLost(now);
      trouble_ = {What::kCardInUse, device_->path()};
      return {rt::Errc::kDeviceLost, error, "commit: not master"};
    case ENODEV:
      machine_.onDeviceGone();
      return {rt::Errc::kDeviceLost, error, "commit: the card is gone"};
    default:
      break;
  }
  if (machine_.state() == ScreenMachine::State::kLighting) {
    machine_.onRefused(now);
    trouble_ = {What::kModeRefused, output_->connector().name, describe(*mode_), error};
  } else {
    machine_.onConfused(now);
  }
  return {rt::Errc::kDeviceLost, error, "commit: refused"};
}

void Screen::release() {
  machine_.release();
  device_->dropMaster();
  output_.reset();
}

Trouble Screen::trouble() const {
  switch (machine_.state()) {
    case ScreenMachine::State::kReleased:
      return {What::kReleased};
    case ScreenMachine::State::kLost:
      return {What::kCardGone, device_->path()};
    case ScreenMachine::State::kSearching:
    case ScreenMachine::State::kLighting:
    case ScreenMachine::State::kShowing:
      break;
  }
  return trouble_;
}

std::string Screen::description() const {
  const std::string card = device_->path() + " (" + device_->driver() + ")";
  if (!output_ || !mode_) return "no screen, " + card;
  return output_->connector().name + ", " + describe(*mode_) + ", " + card;
}

}  // namespace ui::kms
