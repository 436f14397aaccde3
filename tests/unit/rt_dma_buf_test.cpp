#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "rt/dma_buf.h"
#include "rt/memory.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kArenaBytes = 64 * kPageBytes;

rt::LockedArena memoryFileArena() {
  auto arena = rt::LockedArena::create(kArenaBytes, 0, rt::ArenaBacking::kMemoryFile);
  EXPECT_TRUE(arena) << arena.error().where;
  return arena ? std::move(*arena) : rt::LockedArena();
}

/// What a device would read: the dma-buf mapped for itself.
std::vector<std::byte> bytesOf(const rt::DmaBuf& buffer, std::size_t bytes) {
  void* const mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, buffer.part(0).fd, 0);
  if (mapped == MAP_FAILED) return {};
  const auto* first = static_cast<const std::byte*>(mapped);
  std::vector<std::byte> copy(first, first + bytes);
  munmap(mapped, bytes);
  return copy;
}

TEST(MostDmaBufBytes, IsTheKernelsParameter) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "size_limit_mb") << "256\n";
  EXPECT_EQ(rt::mostDmaBufBytes(folder.path()), std::size_t{256} << 20U);
}

TEST(MostDmaBufBytes, IsTheKernelsDefaultWhereTheParameterIsMissingOrNonsense) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(rt::mostDmaBufBytes(folder.path()), std::size_t{64} << 20U);
  for (const char* nonsense : {"", "0\n", "-5\n", "many\n"}) {
    std::ofstream(folder.path() / "size_limit_mb") << nonsense;
    EXPECT_EQ(rt::mostDmaBufBytes(folder.path()), std::size_t{64} << 20U) << nonsense;
  }
}

TEST(DmaBuf, RefusesPartsOfPages) {
  const rt::LockedArena arena = memoryFileArena();
  for (const auto& [offset, bytes] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 0}, {0, 100}, {100, kPageBytes}, {kPageBytes, kPageBytes + 1}}) {
    const auto buffer = rt::DmaBuf::create(arena.memoryFile(), offset, bytes);
    ASSERT_FALSE(buffer);
    EXPECT_EQ(buffer.error().code, rt::Errc::kInvalidConfig);
  }
}

TEST(DmaBuf, SaysWhatIsMissingWhereNoneCanBeMade) {
  const rt::LockedArena arena = memoryFileArena();
  const auto buffer = rt::DmaBuf::create(arena.memoryFile(), 0, kPageBytes);
  if (buffer) GTEST_SKIP() << "this machine makes dma-bufs";
  EXPECT_TRUE(buffer.error().code == rt::Errc::kUnsupported ||
              buffer.error().code == rt::Errc::kNotPermitted);
  EXPECT_STREQ(buffer.error().where, "/dev/udmabuf");
  EXPECT_NE(buffer.error().os_errno, 0);
}

TEST(DmaBuf, PublishingSomethingElseIsRefused) {
  EXPECT_FALSE(rt::publishToDevices(-1));
  const rt::LockedArena arena = memoryFileArena();
  EXPECT_FALSE(rt::publishToDevices(arena.memoryFile()));
}

/// On a machine that makes dma-bufs.
class MadeDmaBuf : public testing::Test {
 protected:
  void SetUp() override {
    const auto probe = rt::DmaBuf::create(arena_.memoryFile(), 0, kPageBytes);
    if (!probe && probe.error().os_errno != 0) {
      GTEST_SKIP() << "no dma-bufs here: " << probe.error().where << ": "
                   << std::strerror(probe.error().os_errno);
    }
  }
  rt::LockedArena arena_ = memoryFileArena();
};

TEST_F(MadeDmaBuf, HoldsThePagesItWasMadeOfWithoutACopy) {
  const auto buffer = rt::DmaBuf::create(arena_.memoryFile(), 2 * kPageBytes, 3 * kPageBytes);
  ASSERT_TRUE(buffer) << buffer.error().where;
  const auto pages = arena_.bytes().subspan(2 * kPageBytes, 3 * kPageBytes);
  for (std::size_t i = 0; i < pages.size(); ++i) pages[i] = static_cast<std::byte>(i * 7 / 5);
  EXPECT_TRUE(rt::publishToDevices(buffer->part(0).fd));
  EXPECT_TRUE(std::ranges::equal(bytesOf(*buffer, pages.size()), pages));
  pages[kPageBytes + 1] ^= std::byte{0xFF};  // written after it was made
  EXPECT_TRUE(rt::publishToDevices(buffer->part(0).fd));
  EXPECT_TRUE(std::ranges::equal(bytesOf(*buffer, pages.size()), pages));
}

TEST_F(MadeDmaBuf, OutlivesItsMemoryFile) {
  arena_.bytes()[0] = std::byte{42};
  const auto buffer = rt::DmaBuf::create(arena_.memoryFile(), 0, kPageBytes);
  ASSERT_TRUE(buffer);
  arena_ = {};
  const auto bytes = bytesOf(*buffer, kPageBytes);
  ASSERT_FALSE(bytes.empty());
  EXPECT_EQ(bytes[0], std::byte{42});
}

TEST_F(MadeDmaBuf, HasANameThatNeverComesAgain) {
  std::vector<std::uint64_t> names;
  for (int i = 0; i < 3; ++i) {
    const auto buffer = rt::DmaBuf::create(arena_.memoryFile(), 0, kPageBytes);
    ASSERT_TRUE(buffer);
    EXPECT_EQ(buffer->part(kPageBytes).offset_bytes, kPageBytes);
    EXPECT_EQ(std::ranges::count(names, buffer->part(0).buffer), 0);
    names.push_back(buffer->part(0).buffer);
  }
}

TEST_F(MadeDmaBuf, IsRefusedBeyondTheMemoryFileAndForOtherFiles) {
  EXPECT_FALSE(rt::DmaBuf::create(arena_.memoryFile(), 0, 1024 * kArenaBytes));
  EXPECT_FALSE(rt::DmaBuf::create(-1, 0, kPageBytes));
  EXPECT_FALSE(rt::DmaBuf::create(STDERR_FILENO, 0, kPageBytes));
}

}  // namespace
