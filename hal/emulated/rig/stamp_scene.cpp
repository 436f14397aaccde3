#include "hal/emulated/rig/stamp_scene.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "hal/emulated/rig/arc_rig.h"
#include "hal/emulated/rig/hall.h"

namespace emulator {

namespace {

StampLayout layoutOf(SizePx size) {
  return StampLayout::of(static_cast<int>(size.width), static_cast<int>(size.height));
}

}  // namespace

std::expected<StampScene, std::string> StampScene::make(std::uint32_t cameras, SizePx size) {
  constexpr std::uint32_t kMinWidth = StampLayout::kMinWidthPx;
  constexpr std::uint32_t kMinHeight = StampLayout::kMinHeightPx;
  if (size.width < kMinWidth || size.height < kMinHeight) {
    return std::unexpected("the stamp scene needs at least " + std::to_string(kMinWidth) + "x" +
                           std::to_string(kMinHeight) + " pixels for its card");
  }
  auto pictures = rt::LockedArena::create(cameras * viewBytes(size));
  if (!pictures) {
    return std::unexpected("the stamp scene's pictures need " +
                           std::to_string(cameras * viewBytes(size) / 1'000'000) +
                           " MB of memory, which is not available: use fewer or smaller cameras");
  }
  return StampScene(makeArcRig(cameras, size), size, std::move(*pictures));
}

std::size_t StampScene::bandBytes(SizePx size) {
  return static_cast<std::size_t>(layoutOf(size).cardHeight()) * size.width;
}

std::size_t StampScene::viewBytes(SizePx size) {
  return std::size_t{size.width} * size.height + kFrameHistory * bandBytes(size);
}

StampScene::StampScene(RigModel rig, SizePx size, rt::LockedArena pictures)
    : rig_(std::move(rig)),
      size_(size),
      layout_(layoutOf(size)),
      card_(layout_),
      pictures_(std::move(pictures)),
      views_(rig_.cameras.size()) {
  const std::span<std::byte> bytes = pictures_.bytes();
  std::span rest(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const auto cut = [&rest](std::size_t size_bytes) {
    const auto piece = rest.first(size_bytes);
    rest = rest.subspan(size_bytes);
    return piece;
  };
  for (View& view : views_) {
    view.hall = cut(std::size_t{size_.width} * size_.height);
    for (auto& band : view.bands) band = cut(bandBytes(size_));
  }
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
  View& view = views_[camera];
  std::ranges::copy(drawHall(rig_.cameras[camera]), view.hall.begin());
  const auto band = view.hall.subspan(band_at, bandBytes(size_));
  for (auto& copy : view.bands) {
    std::ranges::copy(band, copy.begin());
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
  const auto band = view.bands[slot];
  card_.paintTrigger(&band[static_cast<std::size_t>(layout_.left_px)], size_.width,
                     {static_cast<std::uint8_t>(camera), static_cast<std::uint32_t>(trigger)});
  const std::size_t band_at = static_cast<std::size_t>(layout_.top_px) * size_.width;
  const std::span<const std::uint8_t> hall = view.hall;
  return {{hall.first(band_at), band, hall.subspan(band_at + band.size())}};
}

}  // namespace emulator
