#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <pthread.h>
#include <sys/types.h>

#include "rt/result.h"

namespace rt {

enum class SchedPolicy : std::uint8_t {
  kOther,
  kFifo,
  kRoundRobin,
  kForeign,  ///< any other policy of the kernel: only ever reported, never asked for
};

/// How a thread shall run. docs/real-time.md holds the table of all of them.
struct ThreadConfig {
  std::string name;  ///< 1 to 15 characters, as `ps -L` shows it
  SchedPolicy policy = SchedPolicy::kOther;
  int priority = 0;            ///< 1 to 99 for kFifo and kRoundRobin, 0 for kOther
  std::vector<int> cpus = {};  ///< CPUs it may run on; empty: all that the process may use
  std::size_t prefault_stack_bytes = std::size_t{64} * 1024;  ///< touched before the body runs
};

/// What the system granted. A thread runs even if something was refused, then under SCHED_OTHER:
/// a degraded mode, which the caller reports to a person.
struct ThreadGrant {
  bool realtime = true;  ///< policy and priority are as requested
  bool affinity = true;  ///< the CPU set is as requested
  int os_errno = 0;      ///< of the first refusal: EPERM: a privilege is missing

  [[nodiscard]] bool complete() const noexcept { return realtime && affinity; }
};

/// Applies @p config to the calling thread: for threads that a library made
/// (call it in the library's "thread begins" callback). Children of a real-time
/// thread start as SCHED_OTHER, so a library's workers never inherit a priority.
///
/// RT      Not safe: system calls.
/// Errors  kInvalidConfig: the name, policy or priority cannot be asked for.
[[nodiscard]] Result<ThreadGrant> applyToCurrentThread(const ThreadConfig& config);

/// The same for another task of this process, one that a library made and whose code we do not
/// see; its stack is not prefaulted.
[[nodiscard]] Result<ThreadGrant> applyToTask(pid_t tid, const ThreadConfig& config);

/// A named thread with its scheduling, joined on destruction.
///
/// Threads  The owner's; the body runs on the new thread.
/// RT       Not safe: start and stop belong to the set-up world.
/// Errors   kInvalidConfig: the configuration cannot be asked for. kNoMemory: the
///          system makes no more threads. What was not permitted is in grant().
class Thread {
 public:
  static constexpr std::size_t kStackBytes = std::size_t{2} * 1024 * 1024;

  /// Returns when the thread runs with what it was granted.
  [[nodiscard]] static Result<Thread> start(ThreadConfig config,
                                            std::function<void(std::stop_token)> body);

  Thread() noexcept;
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;
  ~Thread();

  void requestStop() noexcept;
  /// Waits until the body has returned. Idempotent.
  void join() noexcept;

  [[nodiscard]] bool joinable() const noexcept { return state_ != nullptr; }
  [[nodiscard]] const ThreadGrant& grant() const noexcept { return grant_; }

 private:
  struct State;

  std::unique_ptr<State> state_;  // set while there is something to join
  pthread_t handle_{};
  ThreadGrant grant_;
};

/// One task of this process as the kernel sees it.
struct TaskInfo {
  pid_t tid = 0;
  std::string name;
  SchedPolicy policy = SchedPolicy::kOther;
  int priority = 0;
  std::vector<int> cpus;
};

/// Every task of this process, library threads included, sorted by tid. Tasks that
/// end meanwhile are left out.
/// RT  Not safe: reads /proc.
[[nodiscard]] std::vector<TaskInfo> listTasks();

}  // namespace rt
