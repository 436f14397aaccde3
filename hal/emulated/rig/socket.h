#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <utility>

#include <unistd.h>

namespace emulator {

/// Owns a file descriptor.
class UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int fd) : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  UniqueFd(const UniqueFd&) = delete;
  UniqueFd& operator=(const UniqueFd&) = delete;
  ~UniqueFd() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// "127.0.0.7" from a host-order address and back.
[[nodiscard]] std::string addressText(std::uint32_t address);
[[nodiscard]] std::expected<std::uint32_t, std::string> parseAddress(const std::string& text);

/// A UDP socket that does not block, bound to @p address (host order) and @p port (0: any).
/// @p shared lets several programs answer the same broadcast. An error says who may hold
/// the port and what to do.
[[nodiscard]] std::expected<UniqueFd, std::string> bindUdp(std::uint32_t address,
                                                           std::uint16_t port, bool shared);

}  // namespace emulator
