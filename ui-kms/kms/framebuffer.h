#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <utility>

namespace ui::kms {

/// Where the planes of a picture lie in the card's memory.
struct FramebufferLayout {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint32_t format = 0;  ///< DRM_FORMAT_...
  std::uint64_t modifier = 0;
  bool has_modifier = false;
  std::array<std::uint32_t, 4> handles{};
  std::array<std::uint32_t, 4> pitches{};  ///< bytes per row
  std::array<std::uint32_t, 4> offsets{};  ///< bytes
};

/// Memory that a plane can show. Taking it away from a plane that shows it darkens the screen.
///
/// Threads  One. The device's descriptor outlives it.
class Framebuffer {
 public:
  Framebuffer() = default;
  /// Errors: errno.
  [[nodiscard]] static std::expected<Framebuffer, int> create(int fd,
                                                              const FramebufferLayout& layout);
  ~Framebuffer();
  Framebuffer(Framebuffer&& other) noexcept : fd_(other.fd_), id_(std::exchange(other.id_, 0)) {}
  Framebuffer& operator=(Framebuffer&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(id_, other.id_);
    return *this;
  }

  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  Framebuffer(int fd, std::uint32_t id) : fd_(fd), id_(id) {}
  int fd_ = -1;
  std::uint32_t id_ = 0;
};

/// Plain memory of the card, 32 bits per pixel (XRGB8888), mapped for the CPU: what every driver
/// has.
///
/// Threads  One. The device's descriptor outlives it.
class DumbBuffer {
 public:
  DumbBuffer() = default;
  /// Errors: errno.
  [[nodiscard]] static std::expected<DumbBuffer, int> create(int fd, std::uint32_t width_px,
                                                             std::uint32_t height_px);
  ~DumbBuffer();
  DumbBuffer(DumbBuffer&& other) noexcept { *this = std::move(other); }
  DumbBuffer& operator=(DumbBuffer&& other) noexcept;

  [[nodiscard]] FramebufferLayout layout() const { return layout_; }
  [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }
  [[nodiscard]] std::uint32_t pitch() const { return layout_.pitches[0]; }

 private:
  int fd_ = -1;
  FramebufferLayout layout_;
  std::span<std::byte> bytes_;
};

}  // namespace ui::kms
