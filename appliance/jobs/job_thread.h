#pragma once

#include <atomic>
#include <expected>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include "appliance/jobs/job_work.h"
#include "appliance/words/phrase.h"
#include "rt/thread.h"

namespace appliance {

/// A work on a thread of its own, `job`: SCHED_OTHER, so that it never delays a picture.
///
/// Threads  The body: `job`. It looks at its stop token often enough to end within a second.
/// Errors   A body that fails returns one line. An exception is a failure with its text.
class JobThread final : public JobWork {
 public:
  class Progress {
   public:
    /// From 0 to 1.
    void set(double progress) { value_.store(progress, std::memory_order_relaxed); }

   private:
    friend class JobThread;
    std::atomic<double> value_{0};
  };
  using Result = std::expected<std::string, std::string>;
  using Body = std::function<Result(Progress&, const std::stop_token&)>;

  [[nodiscard]] static std::expected<std::unique_ptr<JobThread>, Phrase> start(Body body);

  [[nodiscard]] JobReport report() const override;
  void cancel() override { thread_.requestStop(); }

 private:
  JobThread() = default;
  void run(const Body& body, const std::stop_token& stop);
  void end(JobState state, std::string result);

  Progress progress_;
  mutable std::mutex mutex_;
  JobReport report_;  // its progress stands in progress_ while it runs
  rt::Thread thread_;
};

}  // namespace appliance
