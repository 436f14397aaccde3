#include "rt/memory.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <expected>
#include <fstream>
#include <limits>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "rt/limits.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKibibyte = 1024;
constexpr std::size_t kPrefaultChunkBytes = std::size_t{64} * kKibibyte * kKibibyte;
constexpr unsigned kMaxPrefaultThreads = 8;  // beyond it the memory bus is the limit
constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The number after @p key in a file of "key number" lines.
std::optional<std::uint64_t> valueOf(const fs::path& file, std::string_view key) {
  std::ifstream in(file);
  for (std::string word; in >> word;) {
    std::uint64_t value = 0;
    if (word == key && in >> value) return value;
  }
  return std::nullopt;
}

/// The number a file consists of; nullopt for "max", too.
std::optional<std::uint64_t> numberIn(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  if (in >> value) return value;
  return std::nullopt;
}

/// This process's cgroup below the mount point ("0::/a/b" in /proc/self/cgroup).
fs::path cgroupPath(const fs::path& proc) {
  std::ifstream in(proc / "self" / "cgroup");
  for (std::string line; std::getline(in, line);) {
    constexpr std::string_view kVersion2 = "0::/";
    if (line.starts_with(kVersion2)) return line.substr(kVersion2.size());
  }
  return {};
}

/// What the group may still allocate; file cache it can drop counts as available.
std::uint64_t availableInGroup(const fs::path& group) {
  const auto limit = numberIn(group / "memory.max");
  if (!limit) return kNoLimit;
  const std::uint64_t used = numberIn(group / "memory.current").value_or(0);
  const std::uint64_t cache = valueOf(group / "memory.stat", "inactive_file").value_or(0);
  const std::uint64_t held = used - std::min(used, cache);
  return *limit - std::min(*limit, held);
}

std::size_t roundUp(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

std::size_t smallPageBytes() {
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t hugePageBytes() {
  return valueOf("/proc/meminfo", "Hugepagesize:").value_or(0) * kKibibyte;
}

bool transparentHugePagesAllowed(ArenaBacking backing) {
  const bool in_file = backing == ArenaBacking::kMemoryFile;  // the kernel has a switch for each
  std::ifstream in(fs::path("/sys/kernel/mm/transparent_hugepage") /
                   (in_file ? "shmem_enabled" : "enabled"));
  std::string line;
  std::getline(in, line);
  return line.find("[always]") != std::string::npos ||
         line.find(in_file ? "[advise]" : "[madvise]") != std::string::npos;
}

struct Mapping {
  std::byte* data = nullptr;  // none: os_errno says why
  UniqueFd file;
  int os_errno = 0;
};

Mapping refusedMapping() {
  return {.data = nullptr, .file = {}, .os_errno = errno};
}

Mapping map(std::size_t bytes, ArenaBacking backing, bool from_pool) {
  Mapping mapping;
  int flags = MAP_PRIVATE | MAP_ANONYMOUS | (from_pool ? MAP_HUGETLB : 0);
  if (backing == ArenaBacking::kMemoryFile) {
    const unsigned pool_flag = from_pool ? MFD_HUGETLB : 0;
    mapping.file = UniqueFd(memfd_create("kagami", MFD_CLOEXEC | MFD_ALLOW_SEALING | pool_flag));
    if (!mapping.file.valid() || ftruncate(mapping.file.get(), static_cast<off_t>(bytes)) != 0 ||
        fcntl(mapping.file.get(), F_ADD_SEALS, F_SEAL_SHRINK) != 0) {
      return refusedMapping();
    }
    flags = MAP_SHARED;
  }
  void* const address = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, flags, mapping.file.get(), 0);
  if (address == MAP_FAILED) return refusedMapping();
  mapping.data = static_cast<std::byte*>(address);
  return mapping;
}

/// Makes every page present; the error number where the kernel could not.
int prefaultChunk(std::span<std::byte> chunk) {
  // Unlike touching, this reports a failure instead of raising SIGBUS.
  if (madvise(chunk.data(), chunk.size(), MADV_POPULATE_WRITE) == 0) return 0;
  if (errno != EINVAL) return errno;
  for (std::size_t i = 0; i < chunk.size(); i += smallPageBytes()) {  // kernels before 5.14
    static_cast<volatile std::byte&>(chunk[i]) = std::byte{0};
  }
  return 0;
}

/// Up to @p count threads that run @p work; fewer where the system makes no more.
template <typename Work>
std::vector<std::jthread> startHelpers(unsigned count, const Work& work) {
  std::vector<std::jthread> helpers;
  helpers.reserve(count);
  try {
    for (unsigned i = 0; i < count; ++i) helpers.emplace_back(work);
  } catch (const std::system_error&) {
    return helpers;
  }
  return helpers;
}

/// Zeroing pages is bound by one CPU, so several share the work.
int prefault(std::span<std::byte> memory) {
  std::atomic<std::size_t> next{0};
  std::atomic<int> error{0};
  const auto work = [&] {
    for (;;) {
      const std::size_t begin = next.fetch_add(kPrefaultChunkBytes);
      if (begin >= memory.size() || error.load() != 0) return;
      const std::size_t size = std::min(kPrefaultChunkBytes, memory.size() - begin);
      if (const int failed = prefaultChunk(memory.subspan(begin, size)); failed != 0) {
        error.store(failed);
      }
    }
  };
  const std::size_t chunks = (memory.size() + kPrefaultChunkBytes - 1) / kPrefaultChunkBytes;
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(
      std::clamp(std::thread::hardware_concurrency(), 1U, kMaxPrefaultThreads), chunks));
  auto helpers = startHelpers(threads - 1, work);
  work();
  helpers.clear();  // joins
  return error.load();
}

}  // namespace

const char* toString(PageKind kind) noexcept {
  switch (kind) {
    case PageKind::kHuge:
      return "huge";
    case PageKind::kTransparentHuge:
      return "transparent huge";
    case PageKind::kSmall:
      break;
  }
  return "small";
}

std::uint64_t availableMemoryBytes(const fs::path& proc, const fs::path& cgroup) {
  std::uint64_t available =
      valueOf(proc / "meminfo", "MemAvailable:").value_or(0) * std::uint64_t{kKibibyte};
  // Every ancestor's limit binds as well.
  for (fs::path relative = cgroupPath(proc);; relative = relative.parent_path()) {
    available = std::min(available, availableInGroup(cgroup / relative));
    if (relative.empty()) return available;
  }
}

Result<LockedArena> LockedArena::create(std::size_t bytes, std::size_t margin_bytes,
                                        ArenaBacking backing) {
  if (bytes == 0) return std::unexpected(Error{Errc::kInvalidConfig, 0, "arena: zero bytes"});
  const auto noMemory = [](int error, const char* where) {
    return std::unexpected(Error{Errc::kNoMemory, error, where});
  };
  const std::size_t huge_page_bytes = hugePageBytes();
  if (bytes >
      std::numeric_limits<std::ptrdiff_t>::max() - std::max(huge_page_bytes, kKibibyte * 4)) {
    return noMemory(ENOMEM, "arena: size");
  }

  ArenaReport report;
  Mapping mapping;
  if (huge_page_bytes != 0) {  // pool pages are set apart already: MemAvailable excludes them
    report = {
        .bytes = roundUp(bytes, huge_page_bytes), .page_kind = PageKind::kHuge, .locked = true};
    mapping = map(report.bytes, backing, /*from_pool=*/true);
  }
  if (mapping.data == nullptr) {
    const bool transparent = huge_page_bytes != 0 && transparentHugePagesAllowed(backing);
    const std::size_t unit = transparent ? huge_page_bytes : smallPageBytes();
    report = {.bytes = roundUp(bytes, unit),
              .page_kind = transparent ? PageKind::kTransparentHuge : PageKind::kSmall};
    const std::uint64_t available = availableMemoryBytes();
    if (available < margin_bytes || report.bytes > available - margin_bytes) {
      return noMemory(ENOMEM, "arena: more than the memory available");
    }
    mapping = map(report.bytes, backing, /*from_pool=*/false);
    if (mapping.data == nullptr) return noMemory(mapping.os_errno, "arena: mmap");
    if (transparent && madvise(mapping.data, report.bytes, MADV_HUGEPAGE) != 0) {
      report.page_kind = PageKind::kSmall;
    }
  }

  LockedArena arena(mapping.data, std::move(mapping.file), report);
  madvise(arena.data_, report.bytes, MADV_DONTDUMP);
  if (const int error = prefault(arena.bytes()); error != 0) {
    return noMemory(error, "arena: prefault");
  }
  if (report.page_kind != PageKind::kHuge) {
    arena.report_.locked = mlock(arena.data_, report.bytes) == 0;
    arena.report_.os_errno = arena.report_.locked ? 0 : errno;
  }
  return arena;
}

LockedArena::LockedArena(LockedArena&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      file_(std::move(other.file_)),
      report_(std::exchange(other.report_, {})) {}

LockedArena& LockedArena::operator=(LockedArena&& other) noexcept {
  if (this != &other) {
    release();
    data_ = std::exchange(other.data_, nullptr);
    file_ = std::move(other.file_);
    report_ = std::exchange(other.report_, {});
  }
  return *this;
}

LockedArena::~LockedArena() {
  release();
}

void LockedArena::release() noexcept {
  if (data_ != nullptr) munmap(data_, report_.bytes);
  data_ = nullptr;
  file_ = UniqueFd();
  report_ = {};
}

MemoryLock lockMemory() {
  const Limits limits = readLimits();
  const auto refused = [&limits](int error) {
    return MemoryLock{.locked = false,
                      .os_errno = error,
                      .message = "memory is not locked, page faults may delay it (" +
                                 toString(limits) +
                                 "): run as root, or set LimitMEMLOCK=infinity in the unit"};
  };
  if (!limits.may_lock_any_amount && limits.memlock_bytes != Limits::kUnlimited) {
    return refused(EPERM);
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) return refused(errno);
  return {.locked = true, .os_errno = 0, .message = {}};
}

}  // namespace rt
