#include "appliance/jobs/job_registry.h"

#include <algorithm>
#include <ranges>
#include <utility>

namespace appliance {

std::expected<JobId, Phrase> JobRegistry::start(JobOrder order) {
  if (running() >= kMostRunning) return std::unexpected(phrase<Word::kTooManyJobs>(kMostRunning));
  const JobId id = ++last_;
  JobReport report = order.work->report();
  jobs_.emplace(id, Job{.kind = std::move(order.kind),
                        .owner = std::move(order.owner),
                        .when_owner_leaves = order.when_owner_leaves,
                        .report = std::move(report),
                        .work = std::move(order.work)});
  begun_.push_back(id);
  return id;
}

bool JobRegistry::cancel(JobId id) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return false;
  if (found->second.work) found->second.work->cancel();
  return true;
}

void JobRegistry::ownerLeft(const std::string& owner) {
  for (auto& [id, job] : jobs_) {
    const bool ends = job.owner == owner && job.when_owner_leaves == WhenOwnerLeaves::kIsCancelled;
    if (ends && job.work) job.work->cancel();
  }
}

JobRegistry::Changes JobRegistry::look() {
  Changes changes{.begun = std::exchange(begun_, {}), .changed = {}, .forgotten = {}};
  for (auto& [id, job] : jobs_) {
    if (!job.work) continue;
    JobReport now = job.work->report();
    if (now.state != JobState::kRunning) job.work.reset();
    if (now == job.report) continue;
    job.report = std::move(now);
    changes.changed.push_back(id);
  }
  std::size_t ended = jobs_.size() - running();
  for (auto job = jobs_.begin(); ended > kMostKept && job != jobs_.end();) {
    if (job->second.work) {
      ++job;
      continue;
    }
    changes.forgotten.push_back(job->first);
    job = jobs_.erase(job);
    --ended;
  }
  return changes;
}

const JobRegistry::Job* JobRegistry::find(JobId id) const {
  const auto found = jobs_.find(id);
  return found == jobs_.end() ? nullptr : &found->second;
}

std::vector<JobId> JobRegistry::ids() const {
  const auto keys = std::views::keys(jobs_);
  return {keys.begin(), keys.end()};
}

std::size_t JobRegistry::running() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(jobs_, [](const auto& job) { return job.second.work != nullptr; }));
}

}  // namespace appliance
