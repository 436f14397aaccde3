#include "ui-kms/render_target.h"

namespace ui {

RenderTarget makeRenderTarget(std::uint32_t width_px, std::uint32_t height_px) {
  RenderTarget target;
  target.width_px = width_px;
  target.height_px = height_px;
  target.colour = gl::makeTexture(GL_RGBA8, static_cast<GLsizei>(width_px),
                                  static_cast<GLsizei>(height_px), GL_LINEAR, GL_CLAMP_TO_EDGE);
  target.framebuffer = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.colour.get(),
                         0);
  return target;
}

rt::Result<void> readTarget(const RenderTarget& target, std::span<std::byte> rgba) {
  if (rgba.size() != std::size_t{4} * target.width_px * target.height_px) {
    return std::unexpected(rt::Error{rt::Errc::kInvalidConfig, 0, "read: size of the buffer"});
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px),
               GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return {};
}

}  // namespace ui
