#include "tests/soak/line_stream.h"

#include <array>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace soak {
namespace {

constexpr int kPipeBytes = 1 << 20;  // seconds of a full rig: the writer never waits for us
constexpr int kLookEvery_ms = 200;

}  // namespace

LineStream::LineStream(const std::filesystem::path& path, Take take) : take_(std::move(take)) {
  ::unlink(path.c_str());
  if (::mkfifo(path.c_str(), 0600) != 0) return;
  // Without waiting for a writer: it is started after us.
  fd_ = rt::UniqueFd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!fd_.valid()) return;
  (void)::fcntl(fd_.get(), F_SETPIPE_SZ, kPipeBytes);
  thread_ = std::thread([this] { read(); });
}

LineStream::~LineStream() {
  stop_ = true;
  join();
}

void LineStream::join() {
  if (thread_.joinable()) thread_.join();
}

void LineStream::read() {
  std::array<char, 1 << 16> chunk{};
  std::string pending;
  while (!stop_) {
    pollfd ready{.fd = fd_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, kLookEvery_ms) <= 0) continue;
    const ssize_t bytes = ::read(fd_.get(), chunk.data(), chunk.size());
    if (bytes == 0) return;  // a hang-up shows only after there was a writer
    if (bytes < 0) continue;
    pending.append(chunk.data(), static_cast<std::size_t>(bytes));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = pending.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
      take_(std::string_view(pending).substr(begin, end - begin));
    }
    pending.erase(0, begin);
  }
}

}  // namespace soak
