#include "ui-kms/kms_display.h"

#include <algorithm>
#include <utility>

#include <gbm.h>

#include "ui-kms/kms/sync_file.h"

namespace ui {
namespace {

// Drivers latch a commit up to the vblank itself or a few lines before; the kernel's worker that
// writes the registers needs to run until then.
constexpr rt::Nanoseconds kCommitMargin = std::chrono::microseconds(500);
// How long after a predicted flip its event is there to be read.
constexpr rt::Nanoseconds kEventDelay = std::chrono::microseconds(200);
constexpr rt::Nanoseconds kFirstFitPause = std::chrono::seconds(1);
constexpr rt::Nanoseconds kLongestFitPause = std::chrono::seconds(8);

rt::Error contextElsewhere() {
  return {rt::Errc::kDeviceLost, 0, "the GL context is bound to another thread"};
}
rt::Error noScreen() {
  return {rt::Errc::kDeviceLost, 0, "no screen"};
}
rt::Error anotherMode() {
  return {rt::Errc::kBusy, 0, "the screen's mode has just changed"};
}

}  // namespace

void KmsDisplay::CloseGbm::operator()(gbm_device* gbm) const {
  gbm_device_destroy(gbm);
}

std::expected<std::unique_ptr<KmsDisplay>, std::string> KmsDisplay::create(
    const KmsConfig& config) {
  if (config.queue_depth != 1 && config.queue_depth != 2) {
    return std::unexpected("display.queue_depth = " + std::to_string(config.queue_depth) +
                           ": give 1 or 2");
  }
  const auto spec = kms::parseModeSpec(config.mode);
  if (!spec) return std::unexpected("display.mode = " + spec.error());
  auto screen =
      kms::Screen::open({.device = config.device, .mode = *spec, .trigger_hz = config.trigger_hz});
  if (!screen) return std::unexpected(screen.error());
  std::unique_ptr<KmsDisplay> display(new KmsDisplay(config, std::move(*screen)));
  auto made = display->makeRenderer();
  if (made) made = display->makeBuffers();
  if (!made) return std::unexpected(made.error());
  display->detach();
  return display;
}

KmsDisplay::KmsDisplay(const KmsConfig& config, std::unique_ptr<kms::Screen> screen)
    : config_(config),
      screen_(std::move(screen)),
      queue_(config.queue_depth),
      drawings_(queue_.buffers()),
      pacer_(config.refresh_hz, kCommitMargin),
      mode_{config.renderer.width_px, config.renderer.height_px, config.refresh_hz} {
  followMode();
}

KmsDisplay::~KmsDisplay() {
  // Where the render thread still holds the context, the objects end with it instead.
  static_cast<void>(renderer_ && renderer_->context().bind());
}

/// On the card itself, so that GL can draw into what the screen shows; else wherever GL draws.
std::expected<void, std::string> KmsDisplay::makeRenderer() {
  RendererConfig wanted = config_.renderer;
  wanted.width_px = mode_.width_px;
  wanted.height_px = mode_.height_px;
  if (config_.path != ScanoutPath::kCopied) {
    gbm_.reset(gbm_create_device(screen_->device().fd()));
    wanted.gbm = gbm_.get();
  }
  auto renderer = Renderer::create(wanted);
  if (!renderer && wanted.gbm != nullptr && !config_.path) {
    wanted.gbm = nullptr;
    renderer = Renderer::create(wanted);
  }
  if (!renderer) return std::unexpected(renderer.error());
  renderer_ = std::move(*renderer);
  path_ = wanted.gbm != nullptr ? ScanoutPath::kDirect : ScanoutPath::kCopied;
  return {};
}

std::expected<void, std::string> KmsDisplay::makeBuffers() {
  const auto make = [this](ScanoutPath path) {
    return ScanoutBuffers::create(screen_->device().fd(), gbm_.get(), renderer_->context(), path,
                                  mode_.width_px, mode_.height_px, queue_.buffers());
  };
  buffers_.reset();
  auto made = make(path_);
  if (!made && path_ == ScanoutPath::kDirect && !config_.path) {
    path_ = ScanoutPath::kCopied;
    made = make(path_);
  }
  if (!made) return std::unexpected(screen_->device().path() + ": " + made.error());
  buffers_ = std::move(*made);
  return {};
}

/// What the screen has become since the last call.
void KmsDisplay::followMode() {
  if (screen_->losses() != losses_) {
    losses_ = screen_->losses();
    queue_.dropAll();
  }
  if (screen_->changes() == changes_) return;
  changes_ = screen_->changes();
  const drmModeModeInfo& mode = *screen_->mode();
  mode_ = {mode.hdisplay, mode.vdisplay, kms::refreshHz(mode)};
  pacer_.restart(mode_.refresh_hz);
  vblanks_known_.reset();
  no_buffers_.clear();
  fit_pause_ = {};
  next_fit_ = {};
}

void KmsDisplay::attend(rt::Timestamp now) {
  events_.clear();
  screen_->readFlips(events_);
  for (const kms::FlipEvent& event : events_) onFlip(event, now);
  screen_->attend(now);
  followMode();
  if (const auto due = queue_.due(); due && buffersFit()) {
    static_cast<void>(submit(due->buffer, due->picture_id, now));
    followMode();
  }
}

void KmsDisplay::onFlip(const kms::FlipEvent& event, rt::Timestamp now) {
  const auto buffer = queue_.pendingBuffer(event.serial);
  if (!buffer) return;
  Drawing& drawing = drawings_[*buffer];
  kms::Vblank vblank{.number = vblank_.number + 1, .at = event.at};
  if (!vblanks_known_) {
    // The first flip of a mode comes with a number and a stamp from before the mode, or with none.
    const auto last = screen_->lastVblank();
    vblanks_known_ = last.has_value();
    if (last) vblank = {.number = std::max(last->number, vblank.number), .at = last->at};
  } else if (*vblanks_known_) {
    // The kernel's counter has 32 bits here; should it go back, we go on by one.
    const auto step =
        static_cast<std::int32_t>(event.sequence - static_cast<std::uint32_t>(vblank_.number));
    if (step > 0) vblank.number = vblank_.number + static_cast<std::uint64_t>(step);
  }
  const bool stamped = vblank.at > drawing.submit;
  if (!stamped) vblank.at = now;
  vblank_ = vblank;
  queue_.onFlip(event.serial, vblank.number, vblank.at);
  if (*vblanks_known_ && stamped) pacer_.onVblank(vblank.number, vblank.at);
  if (!drawing.fence.valid()) return;
  // Only now is it known when the GPU was done. Drivers that finish immediately return a fence that
  // was signalled long ago, one for all.
  if (const auto drawn = kms::signalledAt(drawing.fence.get())) {
    drawing.instants.warp_end = std::max(drawing.instants.warp_end, *drawn);
    pacer_.onPicture(drawing.instants);
  }
  drawing.fence = {};
}

bool KmsDisplay::buffersFit() const {
  return buffers_ && buffers_->widthPx() == mode_.width_px &&
         buffers_->heightPx() == mode_.height_px;
}

/// After a failure the next attempt waits: memory is freed slowly, if at all.
rt::Result<void> KmsDisplay::fitBuffers(rt::Timestamp now) {
  if (buffersFit()) return {};
  queue_.dropAll();
  const rt::Error no_room{rt::Errc::kNoMemory, 0, "render: buffers of the mode's size"};
  if (now < next_fit_) return std::unexpected(no_room);
  auto fitted = renderer_->resize(mode_.width_px, mode_.height_px);
  if (fitted) fitted = makeBuffers();
  if (!fitted) {
    no_buffers_ = fitted.error();
    fit_pause_ = std::clamp(2 * fit_pause_, kFirstFitPause, kLongestFitPause);
    next_fit_ = now + fit_pause_;
    return std::unexpected(no_room);
  }
  no_buffers_.clear();
  return {};
}

hal::DisplayMode KmsDisplay::mode() const {
  const SizePx upright =
      Orientation(config_.renderer.rotation_deg).turned(SizePx{mode_.width_px, mode_.height_px});
  return {upright.width, upright.height, mode_.refresh_hz};
}

std::string_view KmsDisplay::renderer() const {
  return renderer_->context().renderer();
}

rt::Result<hal::RenderInstants> KmsDisplay::render(const hal::Scene& scene) {
  if (!renderer_->context().bind()) return std::unexpected(contextElsewhere());
  const hal::DisplayMode planned = mode_;
  attend(rt::now());
  if (!screen_->takesPictures()) return std::unexpected(noScreen());
  if (mode_.width_px != planned.width_px || mode_.height_px != planned.height_px) {
    return std::unexpected(anotherMode());  // the plan is for the old one
  }
  if (const auto fit = fitBuffers(rt::now()); !fit) return std::unexpected(fit.error());
  const auto buffer = queue_.tryBeginDraw();
  if (!buffer) return std::unexpected(buffer.error());
  Drawing& drawing = drawings_[*buffer];
  const bool fences = path_ == ScanoutPath::kDirect && screen_->takesFences();
  drawing.fence = {};
  drawing.instants =
      renderer_->draw(buffers_->target(*buffer), scene, fences ? &drawing.fence : nullptr);
  buffers_->finishDraw(*buffer);
  if (path_ == ScanoutPath::kCopied) drawing.instants.warp_end = rt::now();
  queue_.finishDraw(*buffer);
  if (!drawing.fence.valid()) pacer_.onPicture(drawing.instants);
  return drawing.instants;
}

rt::Result<rt::Timestamp> KmsDisplay::commit(std::uint64_t picture_id) {
  attend(rt::now());
  if (!screen_->takesPictures()) return std::unexpected(noScreen());
  if (!buffersFit()) return std::unexpected(anotherMode());
  const auto drawn = queue_.drawn();
  if (!drawn) return std::unexpected(rt::Error{rt::Errc::kUnsupported, 0, "commit: nothing drawn"});
  if (!queue_.takesCommit()) {
    return std::unexpected(
        rt::Error{rt::Errc::kBusy, 0, "commit: the last one has not flipped yet"});
  }
  const rt::Timestamp now = rt::now();
  if (queue_.pending()) {
    queue_.queue(*drawn, picture_id);
    return now;
  }
  if (const auto shown = submit(*drawn, picture_id, now); !shown) {
    followMode();
    return std::unexpected(shown.error());
  }
  return now;
}

rt::Result<void> KmsDisplay::submit(std::uint32_t buffer, std::uint64_t picture_id,
                                    rt::Timestamp now) {
  const auto shown =
      screen_->show(buffers_->framebuffer(buffer), drawings_[buffer].fence.get(), serial_ + 1, now);
  if (!shown) return shown;
  drawings_[buffer].submit = now;
  queue_.submitted(buffer, picture_id, ++serial_);
  return shown;
}

std::optional<hal::PageFlip> KmsDisplay::tryPopFlip() {
  attend(rt::now());
  return queue_.tryPopFlip();
}

std::optional<hal::DisplayTiming> KmsDisplay::timing() const {
  if (!screen_->takesPictures()) return std::nullopt;
  return pacer_.timing();
}

std::optional<rt::Timestamp> KmsDisplay::nextCall() const {
  const bool refused = queue_.pending() && queue_.drawn();
  if (!queue_.queued() && !refused) return std::nullopt;
  const rt::Timestamp now = rt::now();
  const auto known = timing();
  if (!known) return now + std::chrono::milliseconds(1);
  return known->vblankAt(known->firstVblankAfter(now - kEventDelay)) + kEventDelay;
}

hal::ScreenStatus KmsDisplay::screen() const {
  hal::ScreenStatus status;
  using State = kms::ScreenMachine::State;
  if (screen_->state() == State::kReleased) {
    status.state = hal::ScreenState::kReleased;
  } else if (!screen_->takesPictures()) {
    status.state = hal::ScreenState::kNoScreen;
  }
  status.changes = screen_->changes();
  const kms::Trouble trouble = no_buffers_.empty()
                                   ? screen_->trouble()
                                   : kms::Trouble{hal::ScreenTrouble::kNoMemory, {}, no_buffers_};
  status.trouble = trouble.what;
  status.os_errno = trouble.os_errno;
  hal::putText(status.subject, trouble.subject);
  hal::putText(status.detail, trouble.detail);
  return status;
}

void KmsDisplay::releaseScreen() {
  screen_->release();
  followMode();
}

void KmsDisplay::takeScreen() {
  screen_->take(rt::now());
}

rt::Result<void> KmsDisplay::readPicture(std::span<std::byte> rgba) {
  if (!renderer_->context().bind()) return std::unexpected(contextElsewhere());
  const auto buffer = queue_.committed();
  if (!buffer) {
    return std::unexpected(rt::Error{rt::Errc::kUnsupported, 0, "read: nothing committed"});
  }
  return renderer_->read(buffers_->target(*buffer), rgba);
}

std::optional<hal::PageFlip> KmsDisplay::committedFlip() const {
  return queue_.committedFlip();
}

std::string KmsDisplay::description() const {
  return screen_->description() +
         (path_ == ScanoutPath::kDirect ? ", drawn in place" : ", drawn elsewhere and copied");
}

}  // namespace ui
