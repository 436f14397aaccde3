#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace appliance {

enum class JobState : std::uint8_t { kRunning, kDone, kFailed, kCancelled };

inline constexpr std::array<std::string_view, 4> kJobStates = {"running", "done", "failed",
                                                               "cancelled"};

[[nodiscard]] constexpr std::string_view nameOf(JobState state) {
  return kJobStates[static_cast<std::size_t>(state)];
}

/// None: no state has that name.
[[nodiscard]] constexpr std::optional<JobState> jobStateOf(std::string_view name) {
  for (std::size_t i = 0; i < kJobStates.size(); ++i)
    if (kJobStates[i] == name) return static_cast<JobState>(i);
  return std::nullopt;
}

/// How a job stands.
struct JobReport {
  JobState state = JobState::kRunning;
  double progress = 0;  ///< 0 to 1
  std::string result;   ///< once it has ended: one line for a person

  friend bool operator==(const JobReport&, const JobReport&) = default;
};

/// What a job does, away from the main thread.
///
/// Threads  All members: main; none of them waits, but the destructor, which ends the work. A work
///          that has ended is destroyed without a wait.
class JobWork {
 public:
  virtual ~JobWork() = default;
  [[nodiscard]] virtual JobReport report() const = 0;
  /// Asks the work to end; report() says when it has.
  virtual void cancel() = 0;
};

}  // namespace appliance
