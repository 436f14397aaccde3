#include "appliance/jobs/job_thread.h"

#include <exception>
#include <utility>

namespace appliance {

std::expected<std::unique_ptr<JobThread>, Phrase> JobThread::start(Body body) {
  std::unique_ptr<JobThread> job(new JobThread);
  JobThread& made = *job;
  auto thread = rt::Thread::start(
      {.name = "job"},
      [&made, body = std::move(body)](const std::stop_token& stop) { made.run(body, stop); });
  if (!thread) return std::unexpected(phrase<Word::kJobThread>(thread.error().where));
  job->thread_ = std::move(*thread);
  return job;
}

void JobThread::run(const Body& body, const std::stop_token& stop) {
  try {
    Result result = body(progress_, stop);
    if (!result) {
      end(JobState::kFailed, std::move(result.error()));
    } else if (stop.stop_requested()) {
      end(JobState::kCancelled, std::move(*result));
    } else {
      progress_.set(1);
      end(JobState::kDone, std::move(*result));
    }
  } catch (const std::exception& fault) {
    end(JobState::kFailed, fault.what());
  }
}

void JobThread::end(JobState state, std::string result) {
  const std::scoped_lock lock(mutex_);
  report_.state = state;
  report_.result = std::move(result);
}

JobReport JobThread::report() const {
  const std::scoped_lock lock(mutex_);
  JobReport report = report_;
  report.progress = progress_.value_.load(std::memory_order_relaxed);
  return report;
}

}  // namespace appliance
