#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "rt/result.h"
#include "rt/unique_fd.h"

namespace rt {

/// Bytes that can still be allocated without swapping or an out-of-memory kill:
/// MemAvailable, or less if a cgroup (version 2) sets a tighter memory.max.
/// 0 when the kernel does not say. The folders are arguments for tests.
/// RT  Not safe: reads files.
[[nodiscard]] std::uint64_t availableMemoryBytes(
    const std::filesystem::path& proc = "/proc",
    const std::filesystem::path& cgroup = "/sys/fs/cgroup");

enum class PageKind : std::uint8_t {
  kHuge,             ///< from the reserved pool (vm.nr_hugepages)
  kTransparentHuge,  ///< asked for; the kernel uses huge pages as far as it finds them
  kSmall,
};
[[nodiscard]] const char* toString(PageKind kind) noexcept;

enum class ArenaBacking : std::uint8_t {
  kPrivate,     ///< memory of this process alone
  kMemoryFile,  ///< a file in memory that cannot shrink: its pages can become dma-bufs (rt::DmaBuf)
};

struct ArenaReport {
  std::size_t bytes = 0;  ///< as mapped: the request rounded up to whole pages
  PageKind page_kind = PageKind::kSmall;
  bool locked = false;  ///< never paged out; without permission it works, but may be
  int os_errno = 0;     ///< why it is not locked
};

/// One big block of memory that is there: page aligned, zero, every page touched,
/// in huge pages where the system has them, locked where permitted.
///
/// Not part of core dumps. Made before the real-time threads start; they only use it.
///
/// Threads  The owner's; the owner decides who may use the bytes.
/// RT       Not safe to make or destroy; bytes() is.
/// Errors   kNoMemory: more than is available less the margin; nothing was allocated
///          then, so no process is killed for it. kInvalidConfig: zero bytes.
class LockedArena {
 public:
  /// Left to the rest of the system.
  static constexpr std::size_t kMarginBytes = std::size_t{512} * 1024 * 1024;

  [[nodiscard]] static Result<LockedArena> create(std::size_t bytes,
                                                  std::size_t margin_bytes = kMarginBytes,
                                                  ArenaBacking backing = ArenaBacking::kPrivate);

  LockedArena() = default;
  LockedArena(LockedArena&& other) noexcept;
  LockedArena& operator=(LockedArena&& other) noexcept;
  ~LockedArena();

  [[nodiscard]] std::span<std::byte> bytes() const noexcept { return {data_, report_.bytes}; }
  [[nodiscard]] const ArenaReport& report() const noexcept { return report_; }
  /// The file whose bytes these are, from its beginning; -1 if the memory is private.
  [[nodiscard]] int memoryFile() const noexcept { return file_.get(); }

 private:
  LockedArena(std::byte* data, UniqueFd file, const ArenaReport& report) noexcept
      : data_(data), file_(std::move(file)), report_(report) {}
  void release() noexcept;

  std::byte* data_ = nullptr;
  UniqueFd file_;
  ArenaReport report_;
};

/// What came of lockMemory().
struct MemoryLock {
  bool locked = false;
  int os_errno = 0;
  std::string message;  ///< when not locked: one line, what and what to do
};

/// Locks everything this process has mapped and will map (mlockall). It does not try if a limit
/// applies: under MCL_FUTURE every later allocation beyond the limit would fail, which is worse
/// than a page fault.
/// RT  Not safe. Call it once, early.
[[nodiscard]] MemoryLock lockMemory();

}  // namespace rt
