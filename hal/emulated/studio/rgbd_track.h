#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/rgbd_view.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/world.h"

namespace emulator::studio {

/// The play as the depth sensor sees it: the empty hall and one picture after the other over it,
/// each drawn together with the moment it lies in (momentOfDepth()), or taken from the cache.
///
/// Threads  A moment's pictures are drawn by one thread; others read them when it is ready.
/// Memory   A fifth of a megabyte for each picture with people in it.
class RgbdTrack {
 public:
  RgbdTrack(std::uint64_t seed, std::uint32_t moments);

  [[nodiscard]] const StudioCamera& camera() const { return camera_; }
  [[nodiscard]] const RgbdView* view() const { return view_.get(); }
  /// Of the picture that lies in @p moment, if one does.
  [[nodiscard]] const RgbdPatch& patch(std::uint32_t moment) const { return patches_[moment]; }
  [[nodiscard]] bool has(std::uint32_t moment) const { return drawn_[moment] != 0; }

  void load(const SceneCache& cache);
  /// Moments [@p first, @p first + @p count).
  void load(const SceneCache& cache, std::uint32_t first, std::uint32_t count);
  void store(SceneCache& cache, std::uint32_t first, std::uint32_t count) const;

  void setHall(const Backdrop& backdrop, SceneCache& cache);
  /// What lies in @p moment, whose light @p people have on them; @p camera is ours among theirs.
  void draw(std::uint32_t moment, const World& world, PeopleRenderer& people, std::size_t camera);

 private:
  StudioCamera camera_;
  std::unique_ptr<RgbdView> view_;
  std::vector<RgbdPatch> patches_;
  std::vector<std::uint8_t> drawn_;
};

}  // namespace emulator::studio
