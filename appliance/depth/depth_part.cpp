#include "appliance/depth/depth_part.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "appliance/box/shared.h"
#include "appliance/depth/depth_loop.h"
#include "appliance/depth/depth_settings.h"
#include "appliance/depth/depth_snapshot.h"
#include "appliance/depth/depth_snapshot_jobs.h"
#include "appliance/depth/depth_text.h"
#include "hal/backends.h"

namespace appliance {
namespace {

StatusSection sectionOf(const DepthReport& report) {
  StatusSection section{.key = "depth",
                        .line = depthText(report),
                        .values = {{"rate_hz", report.rate_hz},
                                   {"frames", static_cast<std::int64_t>(report.sensor.frames)},
                                   {"lost", static_cast<std::int64_t>(report.sensor.lost)},
                                   {"returns", static_cast<std::int64_t>(report.sensor.returns)}}};
  if (report.sight) section.values.push_back({"measured_share", report.sight->measured_share});
  for (const DepthReaderStatus& reader : report.readers) {
    section.values.push_back(
        {"reader_" + reader.name + "_lost", static_cast<std::int64_t>(reader.lost)});
  }
  return section;
}

class DepthPart final : public Part {
 public:
  /// @p status_reader has one pin, @p snapshot_reader kSnapshotPins.
  DepthPart(const Shared& shared, std::unique_ptr<hal::DepthSensor> sensor,
            DepthReader& status_reader, DepthReader& snapshot_reader)
      : shared_(shared),
        loop_(std::move(sensor), shared.depth),
        sight_(std::make_unique<DepthSightReader>(status_reader)),
        snapshots_({.jobs = shared.jobs,
                    .reader = snapshot_reader,
                    .parent = std::filesystem::path(shared.config.state.directory) / "depth",
                    .sensor_name = [this] { return loop_.report().sensor.name; }}) {}

  [[nodiscard]] std::string_view name() const override { return "depth"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    return shared_.threads.startInto(thread_, "depth", {},
                                     [this](const auto& stop) { loop_.run(stop); });
  }

  void stop() override { thread_ = {}; }

  void report(Status& status) const override {
    DepthReport report = loop_.report();
    report.sight = sight_->look();
    status.sections.push_back(sectionOf(report));
    if (const Phrase trouble = depthTrouble(report); !trouble.empty())
      status.degraded.push_back(remarkOf("depth", trouble));
  }

  void addBusObjects(std::vector<BusObject>& objects) override {
    objects.push_back(snapshots_.busObject());
  }

 private:
  const Shared& shared_;
  DepthLoop loop_;
  const std::unique_ptr<DepthSightReader> sight_;  // main's
  DepthSnapshotJobs snapshots_;
  rt::Thread thread_;
};

}  // namespace

MadePart makeDepthPart(const Shared& shared) {
  const DepthSettings& config = shared.config.depth_sensor;
  if (config.backend == "none") return nullptr;
  auto sensor = hal::openDepthSensor(config.backend, config.device);
  if (!sensor) {
    shared.remarks.add("depth", phrase<Word::kDepthMissing>(sensor.error()));
    return nullptr;
  }
  auto status = shared.depth.openReader("status", 1);
  if (!status) return std::unexpected(status.error());
  auto snapshot = shared.depth.openReader("snapshot", kSnapshotPins);
  if (!snapshot) return std::unexpected(snapshot.error());
  return std::make_unique<DepthPart>(shared, std::move(*sensor), **status, **snapshot);
}

}  // namespace appliance
