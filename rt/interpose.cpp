// Takes the place of libc's allocating, locking and sleeping functions in the rtcheck
// build, so that a call inside a real-time section aborts where it happens.
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <dlfcn.h>
#include <execinfo.h>
#include <pthread.h>
#include <unistd.h>

#include "rt/section_check.h"

// glibc's own entries: dlsym() cannot be asked for these, because it allocates.
// NOLINTBEGIN(bugprone-reserved-identifier): the names are glibc's
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* block);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {

void checkAllowed(const char* call) noexcept {
  const int depth = rt::exchangeSectionDepth(0);  // what follows here may allocate
  if (depth == 0) return;
  std::array<char, 16> thread{};
  pthread_getname_np(pthread_self(), thread.data(), thread.size());
  std::array<char, 160> line{};
  const int length = std::snprintf(line.data(), line.size(),
                                   "rt: %s() called inside a real-time section of thread '%s'\n",
                                   call, thread.data());
  (void)!write(STDERR_FILENO, line.data(), static_cast<size_t>(length));
  std::array<void*, 64> frames{};
  const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
  backtrace_symbols_fd(frames.data(), count, STDERR_FILENO);
  abort();
}

/// The function that ours hides. Condition variables have two versions on old
/// architectures, and the unversioned look-up may find the older one.
template <typename Function>
Function* next(const char* name, const char* version = nullptr) noexcept {
  void* symbol = version != nullptr ? dlvsym(RTLD_NEXT, name, version) : nullptr;
  if (symbol == nullptr) symbol = dlsym(RTLD_NEXT, name);
  return std::bit_cast<Function*>(symbol);
}

constexpr const char* kConditionVersion = "GLIBC_2.3.2";

}  // namespace

extern "C" {

void* malloc(size_t size) noexcept {
  checkAllowed("malloc");
  return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) noexcept {
  checkAllowed("calloc");
  return __libc_calloc(count, size);
}

void* realloc(void* block, size_t size) noexcept {
  checkAllowed("realloc");
  return __libc_realloc(block, size);
}

void free(void* block) noexcept {
  if (block == nullptr) return;  // harmless everywhere
  checkAllowed("free");
  __libc_free(block);
}

void* aligned_alloc(size_t alignment, size_t size) noexcept {
  checkAllowed("aligned_alloc");
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  checkAllowed("posix_memalign");
  if (!std::has_single_bit(alignment) || alignment % sizeof(void*) != 0) return EINVAL;
  void* const memory = __libc_memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *block = memory;
  return 0;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  checkAllowed("pthread_mutex_lock");
  static const auto libc = next<decltype(pthread_mutex_lock)>("pthread_mutex_lock");
  return libc(mutex);
}

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  checkAllowed("pthread_cond_wait");
  static const auto libc =
      next<decltype(pthread_cond_wait)>("pthread_cond_wait", kConditionVersion);
  return libc(condition, mutex);
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* until) {
  checkAllowed("pthread_cond_timedwait");
  static const auto libc =
      next<decltype(pthread_cond_timedwait)>("pthread_cond_timedwait", kConditionVersion);
  return libc(condition, mutex, until);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* until) {
  checkAllowed("pthread_cond_clockwait");
  static const auto libc = next<decltype(pthread_cond_clockwait)>("pthread_cond_clockwait");
  return libc(condition, mutex, clock, until);
}

int nanosleep(const timespec* duration, timespec* remaining) {
  checkAllowed("nanosleep");
  static const auto libc = next<decltype(nanosleep)>("nanosleep");
  return libc(duration, remaining);
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* remaining) {
  checkAllowed("clock_nanosleep");
  static const auto libc = next<decltype(clock_nanosleep)>("clock_nanosleep");
  return libc(clock, flags, until, remaining);
}

int usleep(useconds_t microseconds) {
  checkAllowed("usleep");
  static const auto libc = next<decltype(usleep)>("usleep");
  return libc(microseconds);
}

unsigned sleep(unsigned seconds) {
  checkAllowed("sleep");
  static const auto libc = next<decltype(sleep)>("sleep");
  return libc(seconds);
}

}  // extern "C"
