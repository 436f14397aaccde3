#include "hal/emulated/studio/rgbd_track.h"

#include <string>

namespace emulator::studio {
namespace {

constexpr const char* kHallFile = "depth-sensor";

std::string fileOf(std::uint32_t first_moment) {
  return "depth-" + std::to_string(first_moment);
}

}  // namespace

RgbdTrack::RgbdTrack(std::uint64_t seed, std::uint32_t moments)
    : camera_(makeDepthSensor(seed)), patches_(moments), drawn_(moments, 0) {}

void RgbdTrack::load(const SceneCache& cache) {
  const auto bytes = cache.load(kHallFile);
  if (bytes && bytes->size() == RgbdView::savedBytes(camera_.model.image_size))
    view_ = std::make_unique<RgbdView>(camera_, *bytes);
}

void RgbdTrack::load(const SceneCache& cache, std::uint32_t first, std::uint32_t count) {
  const auto bytes = cache.load(fileOf(first));
  if (!bytes) return;
  std::span<const std::byte> rest(*bytes);
  const std::size_t pixels = depthSensorFormat().pixels();
  std::vector<RgbdPatch> patches;
  for (std::uint32_t i = 0; i < count; ++i) {
    auto patch = RgbdPatch::load(rest, pixels);
    if (!patch) return;
    patches.push_back(std::move(*patch));
  }
  if (!rest.empty()) return;
  for (std::uint32_t i = 0; i < count; ++i) {
    patches_[first + i] = std::move(patches[i]);
    drawn_[first + i] = 1;
  }
}

void RgbdTrack::store(SceneCache& cache, std::uint32_t first, std::uint32_t count) const {
  std::vector<std::byte> bytes;
  for (std::uint32_t i = 0; i < count; ++i) patches_[first + i].save(bytes);
  cache.store(fileOf(first), bytes);
}

void RgbdTrack::setHall(const Backdrop& backdrop, SceneCache& cache) {
  view_ = std::make_unique<RgbdView>(camera_, backdrop);
  std::vector<std::byte> bytes;
  view_->save(bytes);
  cache.store(kHallFile, bytes);
}

void RgbdTrack::draw(std::uint32_t moment, const World& world, PeopleRenderer& people,
                     std::size_t camera) {
  // The fourth of every four moments ends before the sensor's next picture.
  if (moment % 4 != 3) {
    const std::uint32_t picture = depthPictures(moment) + moment % 4;
    people.movePeople(world.at(picture / kDepth_hz, 0));
    patches_[moment] =
        view_->develop(people.draw(camera), people.floorShade(), people.drawDepth(camera));
  }
  drawn_[moment] = 1;
}

}  // namespace emulator::studio
