#include "hal/emulated/studio/depth_feed.h"

#include <chrono>
#include <iomanip>
#include <system_error>

#include <nlohmann/json.hpp>

#include "hal/emulated/studio/depth_pace.h"
#include "hal/emulated/studio/rgbd_track.h"

namespace emulator::studio {
namespace {

constexpr rt::Nanoseconds kPeriod(static_cast<std::int64_t>(1e9 / kDepth_hz));

std::expected<void, std::string> writeSensor(const std::filesystem::path& folder,
                                             const StudioCamera& camera) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const CameraModel& m = camera.model;
  const nlohmann::ordered_json sensor = {
      {"format", 1},
      {"image_size_px", {m.image_size.width, m.image_size.height}},
      {"focal_px", m.focal_px},
      {"centre_px", m.centre_px},
      {"rotation_cam_rig", m.rotation},
      {"translation_cam_rig_m", m.translation_m}};
  std::ofstream file(folder / "depth_sensor.json");
  file << sensor.dump(1) << "\n";
  file.flush();
  if (!file) return std::unexpected("cannot write " + (folder / "depth_sensor.json").string());
  return {};
}

}  // namespace

std::expected<std::unique_ptr<DepthFeed>, std::string> DepthFeed::begin(
    const StudioScene& scene, const std::filesystem::path& truth) {
  std::ofstream file;
  if (!truth.empty()) {
    if (auto written = writeSensor(truth, scene.play().rgbd()->camera()); !written)
      return std::unexpected(written.error());
    file.open(truth / "depth.csv");
    file << "number,exposure_ns,second\n" << std::fixed << std::setprecision(6);
    if (!file) return std::unexpected("cannot write " + (truth / "depth.csv").string());
  }
  auto ring = DepthRingWriter::create(depthRingPath(), depthSensorFormat());
  if (!ring) return std::unexpected(ring.error());
  return std::unique_ptr<DepthFeed>(new DepthFeed(scene, std::move(*ring), std::move(file)));
}

DepthFeed::DepthFeed(const StudioScene& scene, DepthRingWriter ring, std::ofstream truth)
    : scene_(scene),
      ring_(std::move(ring)),
      truth_(std::move(truth)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DepthFeed::run(const std::stop_token& stop) {
  const RgbdTrack& track = *scene_.play().rgbd();
  rt::Timestamp due = rt::now();
  while (!stop.stop_requested()) {
    std::this_thread::sleep_until(due);
    const DepthExposure exposure = nextDepthExposure(due, scene_.playing());
    const DepthRingWriter::Canvas canvas = ring_.begin();
    track.view()->drawEmpty(canvas);
    track.patch(momentOfDepth(exposure.picture)).putInto(canvas);
    const std::uint64_t number = ring_.publish(exposure.at);
    if (truth_.is_open()) {
      truth_ << number << ',' << rt::toNs(exposure.at) << ',' << exposure.picture / kDepth_hz
             << '\n'
             << std::flush;
    }
    due = exposure.at + kPeriod;
  }
}

}  // namespace emulator::studio
