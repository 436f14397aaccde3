#include "appliance/render/render_loop.h"

#include <algorithm>
#include <optional>
#include <span>

#include "appliance/geometry/warp_planner.h"
#include "appliance/render/composer.h"
#include "rt/periodic_loop.h"

namespace appliance {
namespace {

// A frame may wait in its socket for three periods: one of them at most is the pictures'.
constexpr double kShareOfPictures = 0.6;
constexpr std::size_t kReadyKnownAfter = 8;  // frames

hal::SourceImage sourceOf(const PinnedFrame& frame, const RigCamera& camera) {
  return {.pixels = frame.pixels,
          .width_px = camera.width_px,
          .height_px = camera.height_px,
          .format = camera.pixel_format,
          .dma_buf = frame.dma_buf};
}

}  // namespace

RenderLoop::RenderLoop(const RenderParts& parts, const RenderParameters& parameters)
    : parts_(parts),
      parameters_(parameters),
      target_(parts.target),
      hold_second_(parts.frames),
      hold_(static_cast<StoredFrames&>(hold_second_)),  // in front of it, no copy of it
      director_(parameters.director),
      views_(parameters.zoom),
      second_views_(parameters.zoom),
      sighted_(hold_, views_),
      allowance_(kShareOfPictures, parameters.trigger_period) {}

void RenderLoop::run(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested()) {
    (void)parts_.board.wake_render.waitUntil(nextWake(rt::now()));
    rt::sleepUntil(allowance_.nextBegin());
    turn();
  }
  recordFlips();
  parts_.display.detach();
}

/// Wakes once a period at the latest: a shown camera that falls silent rings no bell, and its
/// neighbour must take over. While the view moves, each vblank needs a picture.
rt::Timestamp RenderLoop::nextWake(rt::Timestamp now) const noexcept {
  const rt::Timestamp latest = now + parameters_.trigger_period;
  const rt::Timestamp wake = std::min(parts_.display.nextCall().value_or(latest), latest);
  if (!director_.moving()) return wake;
  return std::min(wake, nextMovingPicture(now, parts_.display.timing()).value_or(wake));
}

void RenderLoop::turn() noexcept {
  const rt::Timestamp wake = rt::now();
  takeCommands();
  const RigPin rig = parts_.rigs.newest();  // one for all of this picture
  if (rig.revision() != on_arc_) director_.setArc(arcOf(*rig));
  on_arc_ = rig.revision();
  Wanted wanted;
  wanted.rig = rig.revision();
  wanted.picture = presentationOf(wake, parts_.display.timing());
  wanted.shot = director_.tick(wanted.picture, parameters_.trigger_period, sighted_,
                               std::span(commands_).first(command_count_));
  command_count_ = 0;
  hold_second_.keep(wanted.shot.hold_second);
  hold_.keep(wanted.shot.hold);
  overlay_ = &parts_.overlay.overlay.latest();
  wanted.overlay = overlay_->generation;
  sayWhatIsShown(wanted.shot);
  Frames frames;
  const bool ready = pin(wanted.shot, frames);
  wanted.target_point_begin = rt::now();
  wanted.first = momentOf(frames[0], *rig);
  if (frames[1]) wanted.second = momentOf(frames[1], *rig);
  wanted.target_point_end = rt::now();
  parts_.board.shown_camera.store(wanted.shot.camera_shown, std::memory_order_relaxed);

  followScreen();
  const bool visible = counters_.screen.state == hal::ScreenState::kShowing;
  if (visible && ready && !onScreen(wanted, wake) && mayDraw(wanted, wake) &&
      show(wanted, rig, frames, wake)) {
    on_screen_ = wanted;
    shown_at_ = wake;
    stale_ = false;
    first_command_ = {};
  }
  recordFlips();
  talkToGenlock();
  counters_.shot = wanted.shot;
  counters_.target = wanted.first.target;
  counters_.exposure_middle = wanted.first.exposure_middle;
  parts_.shown.exposure_middle.store(wanted.first.exposure_middle, std::memory_order_relaxed);
  status_.publish(counters_);
  answerCommands();
  parts_.shown.mode.store(wanted.shot.mode, std::memory_order_relaxed);
}

void RenderLoop::sayWhatIsShown(const Shot& shot) noexcept {
  const hal::DisplayMode mode = parts_.display.mode();
  const OverlaySubject subject{.shot = shot,
                               .cameras = parts_.frames.cameras(),
                               .width_px = mode.width_px,
                               .height_px = mode.height_px};
  if (subject == subject_) return;
  subject_ = subject;
  parts_.overlay.subject.publish(subject);
  parts_.overlay.subject_changed.ring();
}

/// Called after the status was published, so that a caller finds what its command did.
void RenderLoop::answerCommands() noexcept {
  const auto outcomes = director_.outcomes();
  bool waited = false;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (command_ids_[i] == 0) continue;
    parts_.commands.answers().give({.id = command_ids_[i], .outcome = outcomes[i]});
    waited = true;
  }
  if (waited) parts_.commands.answers().ring();
}

void RenderLoop::takeCommands() noexcept {
  while (command_count_ < commands_.size()) {
    const auto event = parts_.commands.tryTake();
    if (!event) break;
    command_ids_[command_count_] = event->id;
    commands_[command_count_++] = event->command;
    if (first_command_ == rt::Timestamp{}) first_command_ = event->at;
  }
}

/// Without a screen nothing is drawn. A screen that came back or changed gets its picture
/// immediately, even if the moment is stopped.
void RenderLoop::followScreen() noexcept {
  hal::Display& display = parts_.display;
  const bool released = counters_.screen.state == hal::ScreenState::kReleased;
  if (screen_released_.load(std::memory_order_relaxed) != released) {
    released ? display.takeScreen() : display.releaseScreen();
  }
  const hal::ScreenStatus screen = display.screen();
  if (screen.changes != counters_.screen.changes) stale_ = true;
  counters_.screen = screen;
}

/// Whether the screen already shows what is wanted. A new overlay alone is drawn only if the last
/// picture is half a period old: while views change quickly, the next picture carries it.
bool RenderLoop::onScreen(const Wanted& wanted, rt::Timestamp now) const noexcept {
  const bool overlay_waits = now < shown_at_ + parameters_.trigger_period / 2;
  return picture_id_ != 0 && !stale_ && first_command_ == rt::Timestamp{} &&
         wanted.shot.trigger == on_screen_.shot.trigger &&
         wanted.shot.camera_shown == on_screen_.shot.camera_shown &&
         (wanted.overlay == on_screen_.overlay || overlay_waits) &&
         wanted.shot.second == on_screen_.shot.second &&
         wanted.shot.composition == on_screen_.shot.composition &&
         !looksDifferent(on_screen_.first.target, wanted.first.target) &&
         !looksDifferent(on_screen_.second.target, wanted.second.target) &&
         wanted.rig == on_screen_.rig;
}

/// False if a frame was overtaken since the decision: the next turn decides again.
bool RenderLoop::pin(const Shot& shot, Frames& frames) noexcept {
  auto& [first, second] = frames;
  if (shot.trigger != 0) first = hold_.tryPin(shot.camera_shown, shot.trigger);
  if (shot.second.trigger != 0) second = hold_.tryPin(shot.second.camera, shot.second.trigger);
  return (first || shot.trigger == 0) && (second || shot.second.trigger == 0);
}

RenderLoop::Moment RenderLoop::momentOf(const std::optional<PinnedFrame>& frame,
                                        const Rig& rig) noexcept {
  Moment moment;
  if (frame) moment.trigger_edge = frame->frame.trigger_edge;
  if (moment.trigger_edge != rt::Timestamp{})
    moment.exposure_middle = moment.trigger_edge + parameters_.edge_to_exposure_middle;
  moment.target =
      target_.at(moment.exposure_middle, {rig.target_m.x(), rig.target_m.y(), rig.target_m.z()});
  return moment;
}

/// While triggers are locked to the screen, an older picture never takes the vblank of the next
/// live one. Therefore two kinds of pictures are not drawn if they would flip at that vblank: the
/// moment on screen once more (the next picture shows what changed), and a moment that missed its
/// own vblank. At most one new moment in a row is skipped, so that the screen never freezes when
/// all pictures are late.
bool RenderLoop::mayDraw(const Wanted& wanted, rt::Timestamp now) noexcept {
  const Shot& shot = wanted.shot;
  const bool is_new = shot.trigger != on_screen_.shot.trigger;
  if (!locked_ || stale_ || shot.mode != Mode::kLive || (is_new && held_back_) ||
      locked_->redrawFits(now, wanted.first.trigger_edge)) {
    held_back_ = false;
    return true;
  }
  held_back_ = is_new;
  return false;
}

void RenderLoop::evenOut(hal::WarpPlan& plan, std::uint32_t camera) noexcept {
  const hal::SourceImage& source = plan.source;
  const std::size_t bytes = std::size_t{source.width_px} * source.height_px;
  const double luminance =
      backgroundLuminance({source.pixels, bytes}, source.width_px, source.height_px) -
      double{plan.colour.black_level};
  const float gain = flicker_.gain(camera, luminance);
  for (float& colour : plan.colour.gain_rgb) colour *= gain;
  counters_.flicker = flicker_.report();
}

/// Both shots' layers in their places, each by its own target.
void RenderLoop::compose(const Wanted& wanted, const RigPin& rig, const Frames& frames,
                         hal::Scene& scene) noexcept {
  const Shot& shot = wanted.shot;
  const std::array shown = {ShownFrame{shot.camera_shown, shot.trigger}, shot.second};
  const hal::DisplayMode mode = parts_.display.mode();
  const auto [places, count] = arrange(shot.composition);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!frames[i]) continue;
    ViewSet& views = i == 0 ? views_ : second_views_;
    const Target& target = (i == 0 ? wanted.first : wanted.second).target;
    views.update(rig, mode.width_px, mode.height_px, target.point.vector());
    const std::uint32_t camera = shown[i].camera;
    auto plan = views.plan(rig, camera, sourceOf(*frames[i], rig->cameras[camera]));
    if (!plan) continue;
    if (parameters_.flicker_compensation) evenOut(*plan, camera);
    scene.layers[scene.count++] = placed(*plan, hal::contentOf(camera, shown[i].trigger), places[i],
                                         mode.width_px, mode.height_px);
  }
}

bool RenderLoop::show(const Wanted& wanted, const RigPin& rig, const Frames& frames,
                      rt::Timestamp wake) noexcept {
  const Shot& shot = wanted.shot;
  const std::optional<PinnedFrame>& frame = frames[0];
  PictureRecord record{.picture_id = picture_id_ + 1,
                       .mode = shot.mode,
                       .substitute = shot.substitute != Substitute::kNone,
                       .camera_wanted = shot.camera_wanted,
                       .camera_shown = shot.camera_shown,
                       .trigger = shot.trigger,
                       .second = shot.second,
                       .wake = wake,
                       .button_event = first_command_};

  hal::Scene scene{.overlay = overlay_};
  if (frame) {
    record.target_point_begin = wanted.target_point_begin;
    record.target_point_end = wanted.target_point_end;
    record.homographies_begin = rt::now();
    compose(wanted, rig, frames, scene);
    noteViews();
    record.homographies_end = rt::now();
  }

  const auto drawn = parts_.display.render(scene);
  const rt::Timestamp drawn_at = rt::now();
  allowance_.spend(wake, drawn_at);  // a picture that the display refuses took its time, too
  const bool new_live = shot.mode == Mode::kLive && shot.trigger != on_screen_.shot.trigger;
  if (drawn && frame && new_live) {
    noteReady(frame->frame);
    if (locked_) rt::sleepUntil(locked_->earliestCommit(wanted.first.trigger_edge));
  } else if (drawn && director_.moving()) {
    rt::sleepUntil(wanted.picture.earliestCommit());
  }
  const auto commit = drawn ? parts_.display.commit(record.picture_id)
                            : rt::Result<rt::Timestamp>(std::unexpected(drawn.error()));
  if (!commit) {
    metrics_.skipped.add();
    return false;
  }
  metrics_.committed(record.picture_id, *commit, parts_.display.timing());
  metrics_.draw.add(drawn_at - wake);
  if (shot.trigger != on_screen_.shot.trigger) metrics_.sets_shown.add();
  picture_id_ = record.picture_id;
  record.imported = drawn->imported;
  record.warp_submit = drawn->warp_submit;
  record.upload_end = drawn->upload_end;
  record.warp_end = drawn->warp_end;
  record.commit = *commit;
  if (parts_.trace != nullptr) parts_.trace->record(record);
  if (parts_.observer != nullptr) {
    parts_.observer->onPicture({.record = record, .scene = scene});
  }
  return true;
}

void RenderLoop::noteViews() noexcept {
  counters_.blind = 0;
  for (std::uint32_t i = 0; i < parts_.frames.cameras(); ++i) {
    if (views_.sight(i) == Sight::kNone) counters_.blind |= std::uint64_t{1} << i;
  }
  if (!views_.cover()) return;
  counters_.cover_worst = views_.cover()->worst;
  counters_.cover_needed = views_.cover()->needed[counters_.cover_worst];
}

void RenderLoop::noteReady(const StoredFrame& frame) noexcept {
  // The frame is readable microseconds after its last packet.
  if (frame.trigger_edge == rt::Timestamp{} || frame.last_packet <= frame.trigger_edge) return;
  ready_delay_.add(frame.last_packet - frame.trigger_edge);
  metrics_.ready_delay.add(frame.last_packet - frame.trigger_edge);
}

void RenderLoop::recordFlips() noexcept {
  while (const auto flip = parts_.display.tryPopFlip()) {
    metrics_.flipped(*flip);
    if (parts_.trace == nullptr) continue;
    parts_.trace->record(FlipRecord{
        .picture_id = flip->picture_id, .page_flip = flip->page_flip, .vblank = flip->vblank});
  }
}

void RenderLoop::talkToGenlock() noexcept {
  const auto timing = parts_.display.timing();
  const bool known = ready_delay_.count() >= kReadyKnownAfter;
  parts_.board.genlock.input.publish(
      {.timing = timing, .ready_delay = known ? ready_delay_.high() : rt::Nanoseconds{0}});
  const auto lock = parts_.board.genlock.status.tryLoad();
  if (!lock) return;  // being written: as it was
  locked_.reset();
  if (timing && lock->state == GenlockState::kLocked) locked_.emplace(*timing, *lock);
}

}  // namespace appliance
