#include "appliance/capture/camera_array.h"

#include <chrono>
#include <cstdint>
#include <utility>

#include "appliance/capture/camera_settings.h"
#include "appliance/config/durations.h"
#include "appliance/config/thread_schedule.h"
#include "appliance/network/network_plan.h"
#include "hal/backends.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;

// A camera that takes longer joins a rig that already runs.
constexpr rt::Nanoseconds kSettleWithin = 10s;

Association associationOf(const Config& config) {
  const CameraPace pace = config.cameras.trigger_source == hal::kFreeRunning
                              ? CameraPace::kFreeRunning
                              : CameraPace::kTriggered;
  return {periodOf(config.trigger.rate_hz),
          microseconds(commonDelay_us(config.cameras) + config.cameras.exposure_us), pace};
}

CameraAccess accessOf(const Config& config, const RigCamera& camera, std::uint32_t index) {
  const std::string& backend = config.cameras.backend;
  const hal::CameraProfile profile = profileOf(config, camera, index);
  return {
      .probe = [backend, address = profile.address](
                   rt::Nanoseconds timeout) { return hal::probeCamera(backend, address, timeout); },
      .open =
          [backend, profile,
           receive = threadConfig(receiveThreadName(index), config.realtime.receive)] {
            return hal::openCamera(backend, profile, receive);
          },
      .name = profile.name,
      .frame_packets = frameOnWire(std::uint64_t{profile.width_px} * profile.height_px,
                                   profile.packet_size_bytes)
                           .packets};
}

}  // namespace

CameraArray::CameraArray(const Config& config, const Rig& rig, FrameHistory& history,
                         CaptureBoard& board, TraceWriter* trace)
    : rig_(rig) {
  for (std::uint32_t i = 0; i < history.cameras(); ++i) {
    collectors_.push_back(std::make_unique<Collector>(
        i, associationOf(config), history.camera(i), board,
        trace != nullptr ? &trace->addProducer("camera" + std::to_string(i + 1)) : nullptr));
    supervisors_.push_back(std::make_unique<CameraSupervisor>(
        accessOf(config, rig.cameras[i], i), *collectors_[i], history.camera(i), board.edges));
  }
}

std::expected<void, std::string> CameraArray::start() {
  for (std::size_t i = 0; i < supervisors_.size(); ++i) {
    if (auto started = supervisors_[i]->start(i); !started) return started;
  }
  const rt::Timestamp patience = rt::now() + kSettleWithin;
  for (const auto& supervisor : supervisors_) (void)supervisor->waitSettled(patience);
  return {};
}

void CameraArray::stop() {
  for (const auto& supervisor : supervisors_) supervisor->requestStop();
  for (const auto& supervisor : supervisors_) supervisor->stop();
}

std::vector<CameraStatus> CameraArray::statuses() const {
  const rt::Timestamp now = rt::now();
  std::vector<CameraStatus> statuses;
  for (std::size_t i = 0; i < supervisors_.size(); ++i) {
    const CollectorCounts counts = collectors_[i]->counts();
    const CameraHealth health = supervisors_[i]->health();
    const Phrase reason = reasonOf(health, supervisors_[i]->silentFor(now));
    statuses.push_back({.name = rig_.cameras[i].name,
                        .state = health.state,
                        .trouble = health.trouble,
                        .reason = textOf(reason),
                        .reason_word = reason.word,
                        .frames_lost = counts.missing,
                        .frames_away = counts.away,
                        .frames_incomplete = counts.damaged()});
  }
  return statuses;
}

std::vector<Remark> CameraArray::remarks() const {
  std::vector<Remark> remarks;
  for (std::size_t i = 0; i < supervisors_.size(); ++i) {
    const std::string key = "camera " + std::to_string(i + 1);
    for (const Phrase& remark : supervisors_[i]->remarks())
      remarks.push_back(remarkOf(key, remark));
    if (collectors_[i]->counts().no_slot == 0) continue;
    remarks.push_back(remarkOf(key, phrase<Word::kCameraNoSlot>(rig_.cameras[i].name)));
  }
  return remarks;
}

CollectorCounts CameraArray::counts() const {
  CollectorCounts sum;
  for (const auto& collector : collectors_) sum += collector->counts();
  return sum;
}

}  // namespace appliance
