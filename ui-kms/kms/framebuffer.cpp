#include "ui-kms/kms/framebuffer.h"

#include <cerrno>

#include <drm_fourcc.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace ui::kms {

std::expected<Framebuffer, int> Framebuffer::create(int fd, const FramebufferLayout& layout) {
  std::uint32_t id = 0;
  std::array<std::uint64_t, 4> modifiers{};
  for (std::size_t i = 0; i < modifiers.size(); ++i) {
    if (layout.handles[i] != 0) modifiers[i] = layout.modifier;
  }
  const int failed = layout.has_modifier
                         ? drmModeAddFB2WithModifiers(fd, layout.width_px, layout.height_px,
                                                      layout.format, layout.handles.data(),
                                                      layout.pitches.data(), layout.offsets.data(),
                                                      modifiers.data(), &id, DRM_MODE_FB_MODIFIERS)
                         : drmModeAddFB2(fd, layout.width_px, layout.height_px, layout.format,
                                         layout.handles.data(), layout.pitches.data(),
                                         layout.offsets.data(), &id, 0);
  if (failed != 0) return std::unexpected(errno);
  return Framebuffer(fd, id);
}

Framebuffer::~Framebuffer() {
  if (id_ != 0) drmModeRmFB(fd_, id_);
}

std::expected<DumbBuffer, int> DumbBuffer::create(int fd, std::uint32_t width_px,
                                                  std::uint32_t height_px) {
  drm_mode_create_dumb made{};
  made.width = width_px;
  made.height = height_px;
  made.bpp = 32;
  if (drmIoctl(fd, DRM_IOCTL_MODE_CREATE_DUMB, &made) != 0) return std::unexpected(errno);
  DumbBuffer buffer;
  buffer.fd_ = fd;
  buffer.layout_.width_px = width_px;
  buffer.layout_.height_px = height_px;
  buffer.layout_.format = DRM_FORMAT_XRGB8888;
  buffer.layout_.handles[0] = made.handle;
  buffer.layout_.pitches[0] = made.pitch;
  drm_mode_map_dumb map{};
  map.handle = made.handle;
  if (drmIoctl(fd, DRM_IOCTL_MODE_MAP_DUMB, &map) != 0) return std::unexpected(errno);
  void* mapped = ::mmap(nullptr, made.size, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
                        static_cast<off_t>(map.offset));
  if (mapped == MAP_FAILED) return std::unexpected(errno);
  buffer.bytes_ = {static_cast<std::byte*>(mapped), made.size};
  return buffer;
}

DumbBuffer::~DumbBuffer() {
  if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
  if (layout_.handles[0] != 0) drmCloseBufferHandle(fd_, layout_.handles[0]);
}

DumbBuffer& DumbBuffer::operator=(DumbBuffer&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(layout_, other.layout_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

}  // namespace ui::kms
