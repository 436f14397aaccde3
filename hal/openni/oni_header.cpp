#include "hal/openni/oni_header.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rt/unique_fd.h"

namespace hal::openni {

using namespace std::chrono_literals;

// Magic (4 bytes), version (8), last stamp (8), highest number of a stream (4); little endian.
constexpr off_t kStreamCountAt = 20;
constexpr off_t kHeaderBytes = 24;

std::expected<void, std::string> writeStreamCount(const std::string& path, std::uint32_t count,
                                                  rt::Nanoseconds patience) {
  const rt::UniqueFd file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  const rt::Timestamp end = rt::now() + patience;
  struct stat written{};
  while (::fstat(file.get(), &written) == 0 && written.st_size < kHeaderBytes) {
    if (rt::now() >= end) return std::unexpected(path + ": OpenNI2 does not write it");
    std::this_thread::sleep_for(1ms);
  }
  if (::pwrite(file.get(), &count, sizeof(count), kStreamCountAt) == sizeof(count)) return {};
  return std::unexpected(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace hal::openni
