#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "appliance/jobs/job_work.h"
#include "appliance/words/phrase.h"

namespace appliance {

using JobId = std::uint32_t;

enum class WhenOwnerLeaves : bool { kGoesOn, kIsCancelled };

struct JobOrder {
  std::string kind;   ///< a word: "memory-check"
  std::string owner;  ///< the caller's name on the bus; empty: the box itself
  WhenOwnerLeaves when_owner_leaves = WhenOwnerLeaves::kGoesOn;
  std::unique_ptr<JobWork> work;
};

/// The long work of the box: which jobs run, and how the last ones ended. Pure: look() polls the
/// works and reads no clock.
///
/// Threads  main.
/// Memory   At most kMostRunning works, and the reports of the last kMostKept that ended.
class JobRegistry {
 public:
  static constexpr std::size_t kMostRunning = 4;
  static constexpr std::size_t kMostKept = 16;

  struct Job {
    std::string kind;
    std::string owner;
    WhenOwnerLeaves when_owner_leaves;
    JobReport report;
    std::unique_ptr<JobWork> work;  // null once it has ended
  };
  /// What look() saw since the look before.
  struct Changes {
    std::vector<JobId> begun;
    std::vector<JobId> changed;
    std::vector<JobId> forgotten;
    friend bool operator==(const Changes&, const Changes&) = default;
  };

  /// Errors   Too many run.
  [[nodiscard]] std::expected<JobId, Phrase> start(JobOrder order);

  /// False if there is no such job. A job that has ended stays as it ended.
  bool cancel(JobId id);

  void ownerLeft(const std::string& owner);

  /// Polls the works; call it at each tick.
  [[nodiscard]] Changes look();

  [[nodiscard]] const Job* find(JobId id) const;
  [[nodiscard]] std::vector<JobId> ids() const;

 private:
  [[nodiscard]] std::size_t running() const;

  std::map<JobId, Job> jobs_;  // in the order of their start
  std::vector<JobId> begun_;   // since the last look
  JobId last_ = 0;
};

}  // namespace appliance
