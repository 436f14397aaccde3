#include "appliance/depth/depth_snapshot_jobs.h"

#include <array>
#include <utility>

#include "appliance/control/bus_callbacks.h"
#include "appliance/depth/depth_snapshot.h"
#include "appliance/jobs/job_thread.h"

namespace appliance {
namespace {

int callSnapshot(DepthSnapshotJobs& snapshots, sd_bus_message* message, sd_bus_error* error) {
  std::uint32_t pairs = 0;
  if (const int r = sd_bus_message_read(message, "u", &pairs); r < 0) return r;
  const char* sender = sd_bus_message_get_sender(message);
  const auto job = snapshots.start(pairs, sender != nullptr ? sender : "");
  if (!job) return refuse(error, job.error());
  return sd_bus_reply_method_return(message, "o", jobPath(*job).c_str());
}

const auto kTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_METHOD_WITH_ARGS("Snapshot", SD_BUS_ARGS("u", pairs), SD_BUS_RESULT("o", job),
                            (onMethod<DepthSnapshotJobs, callSnapshot>),
                            SD_BUS_VTABLE_UNPRIVILEGED),
    SD_BUS_VTABLE_END,
});

}  // namespace

std::expected<JobId, Phrase> DepthSnapshotJobs::start(std::uint32_t pairs, std::string caller) {
  if (pairs < 1 || pairs > kMostPairs)
    return std::unexpected(phrase<Word::kSnapshotPairs>(kMostPairs));
  const JobRegistry::Job* last = parts_.jobs.find(last_);
  if (last != nullptr && last->work) return std::unexpected(phrase<Word::kSnapshotRuns>());
  const DepthSnapshotOrder order{
      .folder = snapshotFolder(parts_.parent), .sensor = parts_.sensor_name(), .pairs = pairs};
  auto work = JobThread::start(
      [&reader = parts_.reader, order](JobThread::Progress& progress, const auto& stop) {
        return writeDepthSnapshot(
            reader, order, [&progress](double share) { progress.set(share); }, stop);
      });
  if (!work) return std::unexpected(work.error());
  auto job = parts_.jobs.start({.kind = "depth-snapshot",
                                .owner = std::move(caller),
                                .when_owner_leaves = WhenOwnerLeaves::kIsCancelled,
                                .work = std::move(*work)});
  if (job) last_ = *job;
  return job;
}

BusObject DepthSnapshotJobs::busObject() {
  return {
      .path = kDepthPath, .interface = kDepthInterface, .vtable = kTable.data(), .target = this};
}

}  // namespace appliance
