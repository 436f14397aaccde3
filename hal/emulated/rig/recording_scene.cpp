#include "hal/emulated/rig/recording_scene.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "hal/emulated/rig/picture_reader.h"

namespace emulator {
namespace {

std::size_t freeMemoryBytes() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::size_t kib = 0;
  while (file >> key >> kib) {
    if (key == "MemAvailable:") return kib << 10;
    file.ignore(64, '\n');
  }
  return std::size_t{1} << 30;  // unknown: a gibibyte is everywhere
}

}  // namespace

std::expected<RecordingScene, std::string> RecordingScene::open(
    const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    return std::unexpected("there is no folder " + folder.string() +
                           "; --scene takes 'stamp' or a folder with rig.toml");
  }
  auto rig = readRigFile(folder / "rig.toml");
  if (!rig) return std::unexpected(rig.error());
  const std::size_t budget = freeMemoryBytes() / 2;
  std::size_t used = 0;
  std::size_t count = SIZE_MAX;
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const CameraModel& camera : rig->cameras) {
    const SizePx size = camera.image_size;
    if (size.width % 4 != 0 || size.height % 2 != 0) {
      return std::unexpected((folder / "rig.toml").string() + ": " + camera.name +
                             ": the width must be divisible by 4 and the height even");
    }
    std::fprintf(stderr, "kagami-emulator: reading %s (%zu of %zu)\n", camera.name.c_str(),
                 pictures.size() + 1, rig->cameras.size());
    auto read = readPictures(folder, camera.name, size, budget - used);
    if (!read) return std::unexpected(read.error());
    read->shrink_to_fit();
    used += read->size();
    count = std::min(count, read->size() / (std::size_t{size.width} * size.height));
    pictures.push_back(std::move(*read));
  }
  std::fprintf(stderr, "kagami-emulator: %zu pictures per camera, %zu MiB\n", count, used >> 20);
  return RecordingScene(std::move(*rig), std::move(pictures), count);
}

RecordingScene::RecordingScene(RigModel rig, std::vector<std::vector<std::uint8_t>> pictures,
                               std::size_t picture_count)
    : rig_(std::move(rig)), pictures_(std::move(pictures)), picture_count_(picture_count) {}

std::uint32_t RecordingScene::cameraCount() const {
  return static_cast<std::uint32_t>(rig_.cameras.size());
}

SizePx RecordingScene::sensorSize(std::uint32_t camera) const {
  return rig_.cameras[camera].image_size;
}

std::string RecordingScene::cameraName(std::uint32_t camera) const {
  return rig_.cameras[camera].name;
}

gvsp::Picture RecordingScene::expose(std::uint32_t camera, std::uint64_t trigger,
                                     std::uint32_t /*slot*/) {
  const SizePx size = rig_.cameras[camera].image_size;
  const std::size_t bytes = std::size_t{size.width} * size.height;
  const std::size_t index = (std::max<std::uint64_t>(trigger, 1) - 1) % picture_count_;
  return {{std::span<const std::uint8_t>(pictures_[camera]).subspan(index * bytes, bytes), {}, {}}};
}

}  // namespace emulator
