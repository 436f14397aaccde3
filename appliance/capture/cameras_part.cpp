#include "appliance/capture/cameras_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "appliance/box/shared.h"
#include "appliance/capture/camera_array.h"
#include "appliance/config/durations.h"

namespace appliance {
namespace {

class CamerasPart final : public Part {
 public:
  explicit CamerasPart(const Shared& shared)
      : shared_(shared),
        cameras_(shared.config, shared.rig, shared.history, shared.board, shared.trace) {
    for (std::size_t i = 0; i < cameras_.size(); ++i) metrics_.push_back(metricsOf(i));
  }

  [[nodiscard]] std::string_view name() const override { return "cameras"; }

  [[nodiscard]] std::expected<void, std::string> start() override { return cameras_.start(); }

  void stop() override { cameras_.stop(); }

  void report(Status& status) const override {
    const std::uint64_t stored =
        std::min<std::uint64_t>(shared_.board.edges.newest(), shared_.history.sets());
    status.history_ms = static_cast<std::uint32_t>(
        stored * periodOf(shared_.config.trigger.rate_hz) / std::chrono::milliseconds(1));
    for (Remark& remark : cameras_.remarks()) status.degraded.push_back(std::move(remark));
    for (const Phrase& remark : shared_.history.remarks())
      status.degraded.push_back(remarkOf("history", remark));
    status.cameras = cameras_.statuses();
    const CollectorCounts counts = cameras_.counts();
    status.frames_lost = counts.missing;
    status.frames_away = counts.away;
    status.frames_incomplete = counts.damaged();
    status.frames_unattributed = counts.unattributed;
  }

 private:
  /// Cameras count from 1 for people: camera01.
  [[nodiscard]] MetricsGroup metricsOf(std::size_t camera) const {
    char name[16];
    std::snprintf(name, sizeof name, "camera%02zu", (camera + 1) % 100);
    MetricsGroup group = shared_.metrics.group(name);
    const auto count = [&](const char* what, std::uint64_t CollectorCounts::* which) {
      group.addCount(what, [this, camera, which] { return cameras_.counts(camera).*which; });
    };
    count("frames_stored", &CollectorCounts::stored);
    count("frames_lost", &CollectorCounts::missing);
    count("frames_away", &CollectorCounts::away);
    count("frames_incomplete", &CollectorCounts::incomplete);
    count("frames_wrong_size", &CollectorCounts::wrong_size);
    count("frames_unattributed", &CollectorCounts::unattributed);
    const PacketCounts& packets = cameras_.packets(camera);
    group.add("packets_resent", packets.resent);
    group.add("packets_missing", packets.missing);
    group.add("packet_underruns", packets.underruns);
    return group;
  }

  const Shared& shared_;
  CameraArray cameras_;
  std::vector<MetricsGroup> metrics_;
};

}  // namespace

MadePart makeCamerasPart(const Shared& shared) {
  return std::make_unique<CamerasPart>(shared);
}

}  // namespace appliance
