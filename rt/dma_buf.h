#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "rt/result.h"
#include "rt/unique_fd.h"

namespace rt {

/// A piece of a dma-buf, borrowed. Trivially copyable.
struct DmaBufPart {
  int fd = -1;               ///< of the dma-buf; below 0: there is none
  std::uint64_t buffer = 0;  ///< names the dma-buf as long as the process lives; fds come again
  std::size_t offset_bytes = 0;
  [[nodiscard]] bool valid() const { return fd >= 0; }
};

/// The most bytes that the kernel puts into one dma-buf: udmabuf's parameter size_limit_mb, 64 MiB
/// unless an administrator set it. The folder is an argument for tests.
/// RT  Not safe: reads a file.
[[nodiscard]] std::size_t mostDmaBufBytes(
    const std::filesystem::path& parameters = "/sys/module/udmabuf/parameters");

/// Pages of a memory file (LockedArena's) as a dma-buf, which a GPU can read where they are. Made
/// by /dev/udmabuf; the pages stay in memory as long as the dma-buf or an import of it lives.
///
/// Threads  The owner's.
/// RT       Not safe to make or destroy: pins every page.
/// Errors   kUnsupported: no /dev/udmabuf here, or it refuses this memory. kNotPermitted: it is
///          there, but not for us. kInvalidConfig: not whole pages.
class DmaBuf {
 public:
  [[nodiscard]] static Result<DmaBuf> create(int memory_file, std::size_t offset_bytes,
                                             std::size_t bytes);

  [[nodiscard]] DmaBufPart part(std::size_t offset_bytes) const {
    return {.fd = fd_.get(), .buffer = buffer_, .offset_bytes = offset_bytes};
  }

 private:
  DmaBuf(UniqueFd fd, std::uint64_t buffer) : fd_(std::move(fd)), buffer_(buffer) {}

  UniqueFd fd_;
  std::uint64_t buffer_;
};

/// Makes what the CPU has written visible to the devices that read next; true when it is done. On
/// x86 devices see the CPU's caches and the kernel has nothing to do.
/// RT  Not safe: a system call whose time may grow with the dma-buf.
[[nodiscard]] bool publishToDevices(int dma_buf_fd);

}  // namespace rt
