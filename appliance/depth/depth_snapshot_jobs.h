#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "appliance/control/bus_object.h"
#include "appliance/depth/depth_reader.h"
#include "appliance/jobs/job_registry.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// Starts snapshots of the depth board as jobs, one at a time, and is their object on the bus.
///
/// Threads  main. The running job has the reader.
class DepthSnapshotJobs {
 public:
  static constexpr std::uint32_t kMostPairs = 900;  ///< half a minute at 30 Hz

  struct Parts {
    JobRegistry& jobs;
    DepthReader& reader;                       ///< with a budget of kSnapshotPins
    std::filesystem::path parent;              ///< of the snapshots' folders
    std::function<std::string()> sensor_name;  ///< what the sensor calls itself now
  };

  explicit DepthSnapshotJobs(Parts parts) : parts_(std::move(parts)) {}
  DepthSnapshotJobs(const DepthSnapshotJobs&) = delete;
  DepthSnapshotJobs& operator=(const DepthSnapshotJobs&) = delete;

  /// The job is cancelled when @p caller leaves the bus.
  /// Errors  The number of pairs, or what runs already.
  [[nodiscard]] std::expected<JobId, Phrase> start(std::uint32_t pairs, std::string caller);

  [[nodiscard]] BusObject busObject();

 private:
  const Parts parts_;
  JobId last_ = 0;
};

}  // namespace appliance
