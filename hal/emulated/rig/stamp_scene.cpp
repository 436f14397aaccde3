#include "hal/emulated/rig/stamp_scene.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "hal/emulated/rig/arc_rig.h"
#include "hal/emulated/rig/hall.h"

namespace emulator {

std::expected<StampScene, std::string> StampScene::make(std::uint32_t cameras, SizePx size) {
  constexpr std::uint32_t kMinWidth = StampLayout::kMinWidthPx;
  constexpr std::uint32_t kMinHeight = StampLayout::kMinHeightPx;
  if (size.width < kMinWidth || size.height < kMinHeight) {
    return std::unexpected("the stamp scene needs at least " + std::to_string(kMinWidth) + "x" +
                           std::to_string(kMinHeight) + " pixels for its card");
  }
  return StampScene(makeArcRig(cameras, size), size);
}

StampScene::StampScene(RigModel rig, SizePx size)
    : rig_(std::move(rig)),
      size_(size),
      layout_(StampLayout::of(static_cast<int>(size.width), static_cast<int>(size.height))),
      views_(rig_.cameras.size()) {
  // Drawing takes a fraction of a second per camera: every core takes the next one.
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> painters;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
    painters.emplace_back([&] {
      for (std::size_t camera = next++; camera < views_.size(); camera = next++) draw(camera);
    });
  }
}

void StampScene::draw(std::size_t camera) {
  const std::size_t band_at = static_cast<std::size_t>(layout_.top_px) * size_.width;
  const std::size_t band_bytes = std::size_t{StampLayout::kCardHeightPx} * size_.width;
  View& view = views_[camera];
  view.hall = drawHall(rig_.cameras[camera]);
  const auto band = std::span(view.hall).subspan(band_at, band_bytes);
  for (auto& copy : view.bands) {
    copy.assign(band.begin(), band.end());
    card_.paintFrame(&copy[static_cast<std::size_t>(layout_.left_px)], size_.width,
                     static_cast<std::uint8_t>(camera));
  }
}

std::uint32_t StampScene::cameraCount() const {
  return static_cast<std::uint32_t>(views_.size());
}

SizePx StampScene::sensorSize(std::uint32_t /*camera*/) const {
  return size_;
}

std::string StampScene::cameraName(std::uint32_t camera) const {
  return rig_.cameras[camera].name;
}

gvsp::Picture StampScene::expose(std::uint32_t camera, std::uint64_t trigger, std::uint32_t slot) {
  View& view = views_[camera];
  auto& band = view.bands[slot];
  card_.paintTrigger(&band[static_cast<std::size_t>(layout_.left_px)], size_.width,
                     {static_cast<std::uint8_t>(camera), static_cast<std::uint32_t>(trigger)});
  const std::size_t band_at = static_cast<std::size_t>(layout_.top_px) * size_.width;
  const auto hall = std::span<const std::uint8_t>(view.hall);
  return {{hall.first(band_at), band, hall.subspan(band_at + band.size())}};
}

}  // namespace emulator
