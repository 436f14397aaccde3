#include "hal/emulated/studio/studio_scene.h"

#include <algorithm>

#include "hal/emulated/studio/sensor_view.h"

namespace emulator::studio {
namespace {
constexpr std::size_t kRemembered = 10'000;
}  // namespace

std::expected<std::unique_ptr<StudioScene>, std::string> StudioScene::make(
    const StudioOptions& options, const Play::Progress& progress) {
  auto play = Play::begin(options, progress);
  if (!play) return std::unexpected(play.error());
  const std::size_t bytes =
      std::size_t{options.cameras} * kVariants * options.size.width * options.size.height;
  auto memory = rt::LockedArena::create(bytes);
  if (!memory) {
    return std::unexpected("the studio's pictures need " + std::to_string(bytes / 1'000'000) +
                           " MB of memory, which is not available: use fewer or smaller cameras");
  }
  return std::unique_ptr<StudioScene>(new StudioScene(std::move(*play), std::move(*memory)));
}

StudioScene::StudioScene(std::unique_ptr<Play> play, rt::LockedArena memory)
    : play_(std::move(play)),
      size_(play_->rig().cameras.front().model.image_size),
      memory_(std::move(memory)),
      backgrounds_(cameraCount()) {
  const std::span<std::byte> bytes = memory_.bytes();
  std::span rest(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const auto cut = [&] {
    const auto piece = rest.first(std::size_t{size_.width} * size_.height);
    rest = rest.subspan(piece.size());
    return piece;
  };
  for (std::uint32_t camera = 0; camera < cameraCount(); ++camera) {
    for (std::uint32_t variant = 0; variant < kVariants; ++variant) {
      backgrounds_[camera][variant] = cut();
      std::ranges::copy(play_->background(camera, variant), backgrounds_[camera][variant].begin());
    }
  }
  rounds_.reserve(kRemembered);
  round_ = {.first_trigger = 1, .moments = play_->readyCount()};
  rounds_.push_back(round_);
}

std::uint32_t StudioScene::cameraCount() const {
  return static_cast<std::uint32_t>(play_->rig().cameras.size());
}

SizePx StudioScene::sensorSize(std::uint32_t /*camera*/) const {
  return size_;
}

std::string StudioScene::cameraName(std::uint32_t camera) const {
  return play_->rig().cameras[camera].model.name;
}

std::uint32_t StudioScene::momentOf(std::uint64_t trigger) {
  // A frame that no trigger asked for, or one of a round that is over, shows any moment; this is
  // accepted.
  if (trigger < round_.first_trigger) return static_cast<std::uint32_t>(trigger % round_.moments);
  const std::uint64_t passed = trigger - round_.first_trigger;
  if (passed < round_.moments) return static_cast<std::uint32_t>(passed);
  round_ = {.first_trigger = trigger - passed % round_.moments, .moments = play_->readyCount()};
  if (rounds_.size() < kRemembered) rounds_.push_back(round_);
  return static_cast<std::uint32_t>(trigger - round_.first_trigger);
}

void StudioScene::onAcquisition() {
  play_->rest(rt::now());
}

void StudioScene::onTrigger(std::uint64_t trigger, rt::Timestamp edge) {
  // Rounds begin with exposures; until the next one has, its first moments count on from here.
  const std::uint64_t passed = trigger - std::min(trigger, round_.first_trigger);
  const bool next = trigger == last_trigger_ + 1 && last_trigger_ != 0;
  playing_.store({.moment = static_cast<std::uint32_t>(passed % round_.moments),
                  .moments = round_.moments,
                  .edge = edge,
                  .period = next ? edge - last_edge_ : rt::Nanoseconds{0}});
  last_edge_ = edge;
  last_trigger_ = trigger;
}

gvsp::Picture StudioScene::expose(std::uint32_t camera, std::uint64_t trigger,
                                  std::uint32_t /*slot*/) {
  play_->rest(rt::now());
  const std::uint32_t moment = momentOf(trigger);
  return {.pieces = {backgrounds_[camera][moment % kVariants]},
          .overlay = play_->overlay(moment, camera)};
}

}  // namespace emulator::studio
