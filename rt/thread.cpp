#include "rt/thread.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <expected>
#include <filesystem>
#include <fstream>
#include <future>
#include <utility>

#include <alloca.h>
#include <sched.h>
#include <unistd.h>

namespace rt {
namespace {

constexpr std::size_t kMaxNameLength = 15;
constexpr std::size_t kStackReserveBytes =
    std::size_t{256} * 1024;  // what prefaulting must leave alone

Result<int> kernelPolicy(SchedPolicy policy) {
  switch (policy) {
    case SchedPolicy::kOther:
      return SCHED_OTHER;
    case SchedPolicy::kFifo:
      return SCHED_FIFO;
    case SchedPolicy::kRoundRobin:
      return SCHED_RR;
    case SchedPolicy::kForeign:
      break;
  }
  return std::unexpected(Error{Errc::kInvalidConfig, 0, "thread: policy"});
}

SchedPolicy policyFromKernel(int policy) {
  switch (policy & ~SCHED_RESET_ON_FORK) {
    case SCHED_OTHER:
      return SchedPolicy::kOther;
    case SCHED_FIFO:
      return SchedPolicy::kFifo;
    case SCHED_RR:
      return SchedPolicy::kRoundRobin;
    default:
      return SchedPolicy::kForeign;
  }
}

Result<void> check(const ThreadConfig& config) {
  const auto invalid = [](const char* where) {
    return std::unexpected(Error{Errc::kInvalidConfig, 0, where});
  };
  if (config.name.empty() || config.name.size() > kMaxNameLength) return invalid("thread: name");
  const auto policy = kernelPolicy(config.policy);
  if (!policy) return std::unexpected(policy.error());
  if (config.priority < sched_get_priority_min(*policy) ||
      config.priority > sched_get_priority_max(*policy)) {
    return invalid("thread: priority");
  }
  const bool cpus_in_range =
      std::ranges::all_of(config.cpus, [](int cpu) { return cpu >= 0 && cpu < CPU_SETSIZE; });
  if (!cpus_in_range) return invalid("thread: cpu");
  if (config.prefault_stack_bytes > Thread::kStackBytes - kStackReserveBytes) {
    return invalid("thread: prefault_stack_bytes");
  }
  return {};
}

/// Touches @p bytes of stack below the caller, so that no page fault comes later.
[[gnu::noinline]] void prefaultStack(std::size_t bytes) {
  if (bytes == 0) return;
  const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  auto* const stack = static_cast<volatile std::byte*>(alloca(bytes));
  for (std::size_t i = 0; i < bytes; i += page_bytes) stack[i] = std::byte{0};
}

std::vector<int> cpusOf(pid_t tid) {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(tid, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

}  // namespace

namespace {

/// The kernel's side of @p config for task @p tid of this process; 0: the caller.
ThreadGrant schedule(pid_t tid, const ThreadConfig& config) {
  ThreadGrant grant;
  const auto refuse = [&grant](bool& what, int error) {
    what = false;
    if (grant.os_errno == 0) grant.os_errno = error;
  };
  if (!config.cpus.empty()) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const int cpu : config.cpus) CPU_SET(static_cast<std::size_t>(cpu), &set);
    if (sched_setaffinity(tid, sizeof set, &set) != 0) refuse(grant.affinity, errno);
  }
  const bool realtime = config.policy != SchedPolicy::kOther;
  const int policy = *kernelPolicy(config.policy);
  const sched_param parameter{.sched_priority = config.priority};
  if (sched_setscheduler(tid, realtime ? policy | SCHED_RESET_ON_FORK : policy, &parameter) != 0) {
    refuse(grant.realtime, errno);
    const sched_param none{.sched_priority = 0};
    sched_setscheduler(tid, SCHED_OTHER, &none);  // never an inherited priority
  }
  return grant;
}

}  // namespace

Result<ThreadGrant> applyToCurrentThread(const ThreadConfig& config) {
  if (const auto valid = check(config); !valid) return std::unexpected(valid.error());
  pthread_setname_np(pthread_self(), config.name.c_str());
  prefaultStack(config.prefault_stack_bytes);
  return schedule(0, config);
}

Result<ThreadGrant> applyToTask(pid_t tid, const ThreadConfig& config) {
  if (const auto valid = check(config); !valid) return std::unexpected(valid.error());
  std::ofstream("/proc/self/task/" + std::to_string(tid) + "/comm") << config.name;
  return schedule(tid, config);
}

struct Thread::State {
  ThreadConfig config;
  std::function<void(std::stop_token)> body;
  std::stop_source stop;
  std::promise<ThreadGrant> applied;

  static void* run(void* argument) {
    auto& state = *static_cast<State*>(argument);
    const auto grant = applyToCurrentThread(state.config);
    assert(grant && "start() has checked the configuration");
    state.applied.set_value(*grant);
    state.body(state.stop.get_token());
    return nullptr;
  }
};

Result<Thread> Thread::start(ThreadConfig config, std::function<void(std::stop_token)> body) {
  if (const auto valid = check(config); !valid) return std::unexpected(valid.error());
  Thread thread;
  thread.state_ = std::make_unique<State>();
  thread.state_->config = std::move(config);
  thread.state_->body = std::move(body);
  auto applied = thread.state_->applied.get_future();

  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  const int error = pthread_create(&thread.handle_, &attributes, &State::run, thread.state_.get());
  pthread_attr_destroy(&attributes);
  if (error != 0) {
    thread.state_.reset();
    return std::unexpected(Error{Errc::kNoMemory, error, "thread: pthread_create"});
  }
  thread.grant_ = applied.get();
  return thread;
}

Thread::Thread() noexcept = default;

Thread::Thread(Thread&& other) noexcept
    : state_(std::move(other.state_)), handle_(other.handle_), grant_(other.grant_) {}

Thread& Thread::operator=(Thread&& other) noexcept {
  if (this != &other) {
    requestStop();
    join();
    state_ = std::move(other.state_);
    handle_ = other.handle_;
    grant_ = other.grant_;
  }
  return *this;
}

Thread::~Thread() {
  requestStop();
  join();
}

void Thread::requestStop() noexcept {
  if (state_) state_->stop.request_stop();
}

void Thread::join() noexcept {
  if (!state_) return;
  pthread_join(handle_, nullptr);
  state_.reset();
}

std::vector<TaskInfo> listTasks() {
  std::vector<TaskInfo> tasks;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
    const std::string tid_text = entry.path().filename();
    TaskInfo task;
    std::from_chars(tid_text.data(), tid_text.data() + tid_text.size(), task.tid);
    std::ifstream comm(entry.path() / "comm");
    const int policy = sched_getscheduler(task.tid);
    sched_param parameter{};
    if (!std::getline(comm, task.name) || policy < 0 || sched_getparam(task.tid, &parameter) != 0) {
      continue;  // it has just ended
    }
    task.policy = policyFromKernel(policy);
    task.priority = parameter.sched_priority;
    task.cpus = cpusOf(task.tid);
    tasks.push_back(std::move(task));
  }
  std::ranges::sort(tasks, {}, &TaskInfo::tid);
  return tasks;
}

}  // namespace rt
