#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "rt/limits.h"
#include "rt/memory.h"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMiB = std::size_t{1024} * 1024;

/// A folder that looks like /proc and /sys/fs/cgroup, removed at the end.
class FakeSystem {
 public:
  FakeSystem() : root_(fs::temp_directory_path() / ("rt_memory_" + std::to_string(getpid()))) {
    fs::create_directories(root_);
  }
  ~FakeSystem() { fs::remove_all(root_); }
  FakeSystem(const FakeSystem&) = delete;
  FakeSystem& operator=(const FakeSystem&) = delete;

  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  [[nodiscard]] std::uint64_t available() const {
    return rt::availableMemoryBytes(root_ / "proc", root_ / "cgroup");
  }

 private:
  fs::path root_;
};

TEST(AvailableMemory, IsWhatTheKernelSaysWhenNoGroupLimitsIt) {
  const FakeSystem system;
  system.write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 100 kB\nMemAvailable:    2000 kB\n");
  EXPECT_EQ(system.available(), 2000u * 1024);
}

TEST(AvailableMemory, IsLessWhenAnyEnclosingGroupIsTighter) {
  const FakeSystem system;
  system.write("proc/meminfo", "MemAvailable: 2000 kB\n");
  system.write("proc/self/cgroup", "0::/outer/inner\n");
  system.write("cgroup/outer/inner/memory.max", "max\n");
  system.write("cgroup/outer/memory.max", "1024000\n");
  system.write("cgroup/outer/memory.current", "500000\n");
  EXPECT_EQ(system.available(), 524'000u);

  // file cache that the group can drop counts as available
  system.write("cgroup/outer/memory.stat", "anon 7\ninactive_file 100000\n");
  EXPECT_EQ(system.available(), 624'000u);
}

TEST(AvailableMemory, IsZeroNotNegativeInAGroupOverItsLimit) {
  const FakeSystem system;
  system.write("proc/meminfo", "MemAvailable: 2000 kB\n");
  system.write("proc/self/cgroup", "0::/\n");
  system.write("cgroup/memory.max", "1000\n");
  system.write("cgroup/memory.current", "5000\n");
  EXPECT_EQ(system.available(), 0u);
}

TEST(AvailableMemory, IsZeroWhenTheKernelDoesNotSay) {
  const FakeSystem system;
  EXPECT_EQ(system.available(), 0u);
}

class EveryArena : public testing::TestWithParam<rt::ArenaBacking> {};
INSTANTIATE_TEST_SUITE_P(Backing, EveryArena,
                         testing::Values(rt::ArenaBacking::kPrivate, rt::ArenaBacking::kMemoryFile),
                         [](const auto& test) {
                           return test.param == rt::ArenaBacking::kPrivate ? "Private"
                                                                           : "MemoryFile";
                         });

TEST_P(EveryArena, IsAlignedZeroedWholeAndPresent) {
  const auto arena = rt::LockedArena::create(65 * kMiB + 1, 0, GetParam());
  ASSERT_TRUE(arena.has_value()) << arena.error().where;
  const auto bytes = arena->bytes();
  EXPECT_GE(bytes.size(), 65 * kMiB + 1);
  EXPECT_EQ(bytes.size(), arena->report().bytes);
  const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.data()) % page_bytes, 0u);
  EXPECT_TRUE(std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; }));

  std::vector<unsigned char> resident(bytes.size() / page_bytes);
  ASSERT_EQ(mincore(bytes.data(), bytes.size(), resident.data()), 0);
  EXPECT_TRUE(std::ranges::all_of(resident, [](unsigned char r) { return (r & 1U) != 0; }));
}

TEST_P(EveryArena, IsLockedOrSaysWhyNot) {
  const auto arena = rt::LockedArena::create(4 * kMiB, 0, GetParam());
  ASSERT_TRUE(arena.has_value());
  EXPECT_EQ(arena->report().locked, arena->report().os_errno == 0);
  const rt::Limits limits = rt::readLimits();
  if (limits.may_lock_any_amount) {
    EXPECT_TRUE(arena->report().locked);
  }
}

TEST_P(EveryArena, RefusesMoreThanIsAvailableWithoutTryingIt) {
  const auto arena = rt::LockedArena::create(rt::availableMemoryBytes() + 64 * kMiB, 0, GetParam());
  ASSERT_FALSE(arena.has_value());
  EXPECT_EQ(arena.error().code, rt::Errc::kNoMemory);
}

TEST(LockedArena, LeavesTheMarginToTheSystem) {
  const std::uint64_t available = rt::availableMemoryBytes();
  EXPECT_FALSE(rt::LockedArena::create(64 * kMiB, available).has_value());
  EXPECT_FALSE(rt::LockedArena::create(64 * kMiB, 2 * available).has_value());
}

TEST(LockedArena, RefusesNonsenseSizes) {
  EXPECT_EQ(rt::LockedArena::create(0).error().code, rt::Errc::kInvalidConfig);
  for (const std::size_t huge : {SIZE_MAX, SIZE_MAX - 4096, SIZE_MAX / 2}) {
    EXPECT_EQ(rt::LockedArena::create(huge).error().code, rt::Errc::kNoMemory);
  }
}

TEST_P(EveryArena, MovesItsMemoryAndFreesItOnce) {
  auto first = rt::LockedArena::create(2 * kMiB, 0, GetParam());
  auto second = rt::LockedArena::create(2 * kMiB, 0, GetParam());
  ASSERT_TRUE(first && second);
  auto* const data = second->bytes().data();
  *first = std::move(*second);
  EXPECT_EQ(first->bytes().data(), data);
  EXPECT_TRUE(second->bytes().empty());
  first->bytes().back() = std::byte{1};
}

TEST(LockedArena, AMemoryFileHoldsItsBytesAndCannotShrink) {
  auto arena = rt::LockedArena::create(2 * kMiB, 0, rt::ArenaBacking::kMemoryFile);
  ASSERT_TRUE(arena);
  arena->bytes()[kMiB] = std::byte{42};
  std::byte read{};
  ASSERT_EQ(pread(arena->memoryFile(), &read, 1, kMiB), 1);
  EXPECT_EQ(read, std::byte{42});
  EXPECT_NE(ftruncate(arena->memoryFile(), 0), 0);

  const rt::LockedArena moved = std::move(*arena);
  EXPECT_EQ(pread(moved.memoryFile(), &read, 1, kMiB), 1);
  EXPECT_EQ(arena->memoryFile(), -1);  // NOLINT(bugprone-use-after-move)
}

TEST(LockedArena, PrivateMemoryIsNoFile) {
  const auto arena = rt::LockedArena::create(2 * kMiB, 0);
  ASSERT_TRUE(arena);
  EXPECT_EQ(arena->memoryFile(), -1);
}

TEST(LockMemory, LocksOrNamesTheLimitToRaise) {
  const rt::MemoryLock lock = rt::lockMemory();
  EXPECT_EQ(lock.locked, lock.message.empty());
  EXPECT_EQ(lock.locked, lock.os_errno == 0);
  if (!lock.locked) {
    EXPECT_NE(lock.message.find("RLIMIT_MEMLOCK"), std::string::npos);
  }
  munlockall();
}

TEST(Limits, AreNamedInOneLine) {
  EXPECT_EQ(toString(rt::Limits{.memlock_bytes = 8'388'608, .rt_priority = 0}),
            "RLIMIT_MEMLOCK 8388608 bytes, RLIMIT_RTPRIO 0");
  EXPECT_EQ(toString(rt::Limits{.memlock_bytes = rt::Limits::kUnlimited,
                                .rt_priority = 99,
                                .may_lock_any_amount = true,
                                .may_schedule_any = true}),
            "RLIMIT_MEMLOCK unlimited (not binding: CAP_IPC_LOCK), "
            "RLIMIT_RTPRIO 99 (not binding: CAP_SYS_NICE)");
}

}  // namespace
