#include "rt/dma_buf.h"

#include <atomic>
#include <cerrno>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <linux/dma-buf.h>
#include <linux/udmabuf.h>
#include <sys/ioctl.h>

namespace rt {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1024} * 1024;
constexpr std::size_t kDefaultLimitMebibytes = 64;

bool sync(int dma_buf_fd, std::uint64_t flags) {
  const dma_buf_sync request{.flags = flags};
  int failed = 0;
  do {
    failed = ::ioctl(dma_buf_fd, DMA_BUF_IOCTL_SYNC, &request);
  } while (failed != 0 && (errno == EINTR || errno == EAGAIN));
  return failed == 0;
}

Error cannotOpen(int error) {
  if (error == EACCES || error == EPERM) return {Errc::kNotPermitted, error, "/dev/udmabuf"};
  return {Errc::kUnsupported, error, "/dev/udmabuf"};
}

}  // namespace

std::size_t mostDmaBufBytes(const std::filesystem::path& parameters) {
  std::ifstream file(parameters / "size_limit_mb");
  int mebibytes = 0;
  const bool set = file >> mebibytes && mebibytes > 0;
  return (set ? static_cast<std::size_t>(mebibytes) : kDefaultLimitMebibytes) * kMebibyte;
}

Result<DmaBuf> DmaBuf::create(int memory_file, std::size_t offset_bytes, std::size_t bytes) {
  const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (bytes == 0 || bytes % page_bytes != 0 || offset_bytes % page_bytes != 0) {
    return std::unexpected(Error{Errc::kInvalidConfig, 0, "dma-buf: not whole pages"});
  }
  const UniqueFd device(::open("/dev/udmabuf", O_RDWR | O_CLOEXEC));
  if (!device.valid()) return std::unexpected(cannotOpen(errno));

  const udmabuf_create request{.memfd = static_cast<std::uint32_t>(memory_file),
                               .flags = UDMABUF_FLAGS_CLOEXEC,
                               .offset = offset_bytes,
                               .size = bytes};
  UniqueFd fd(::ioctl(device.get(), UDMABUF_CREATE, &request));
  if (!fd.valid()) return std::unexpected(Error{Errc::kUnsupported, errno, "UDMABUF_CREATE"});

  // The CPU's access begins here and never ends, because receiving never ends. If it began later,
  // the kernel could drop what the CPU has written. publishToDevices() makes new content visible.
  if (!sync(fd.get(), DMA_BUF_SYNC_START | DMA_BUF_SYNC_WRITE)) {
    return std::unexpected(Error{Errc::kUnsupported, errno, "DMA_BUF_IOCTL_SYNC"});
  }
  static std::atomic<std::uint64_t> made{0};
  return DmaBuf(std::move(fd), ++made);
}

bool publishToDevices(int dma_buf_fd) {
  return sync(dma_buf_fd, DMA_BUF_SYNC_END | DMA_BUF_SYNC_WRITE);
}

}  // namespace rt
