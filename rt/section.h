#pragma once

namespace rt {

#ifdef KAGAMI_RTCHECK

/// Marks the calling thread as real-time while it lives: in the rtcheck build
/// malloc and free, mutex locks and sleeps inside it abort with a backtrace.
/// In every other build it is empty. Sections nest.
///
/// Threads  Made and destroyed on the same thread.
/// RT       Safe: a thread-local counter.
class ScopedRtSection {
 public:
  ScopedRtSection() noexcept;
  ~ScopedRtSection();
  ScopedRtSection(const ScopedRtSection&) = delete;
  ScopedRtSection& operator=(const ScopedRtSection&) = delete;
};

/// Permits what a section forbids, for the one call that may: a loop's own sleep,
/// the trigger's ioctl. @p reason is a literal that says why that call is bounded.
class ScopedRtExemption {
 public:
  explicit ScopedRtExemption(const char* reason) noexcept;
  ~ScopedRtExemption();
  ScopedRtExemption(const ScopedRtExemption&) = delete;
  ScopedRtExemption& operator=(const ScopedRtExemption&) = delete;

 private:
  int suspended_depth_;
};

#else

class [[maybe_unused]] ScopedRtSection {
 public:
  ScopedRtSection() noexcept = default;
  ScopedRtSection(const ScopedRtSection&) = delete;
  ScopedRtSection& operator=(const ScopedRtSection&) = delete;
};

class [[maybe_unused]] ScopedRtExemption {
 public:
  explicit ScopedRtExemption(const char* /*reason*/) noexcept {}
  ScopedRtExemption(const ScopedRtExemption&) = delete;
  ScopedRtExemption& operator=(const ScopedRtExemption&) = delete;
};

#endif

}  // namespace rt
