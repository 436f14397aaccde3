#include "ui-kms/render_target.h"

#include <algorithm>
#include <cstring>

namespace ui {

std::expected<RenderTarget, std::string> makeRenderTarget(std::uint32_t width_px,
                                                          std::uint32_t height_px, GLenum format) {
  const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px) + " px";
  GLint most_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
  if (std::max(width_px, height_px) > static_cast<std::uint32_t>(most_px)) {
    return std::unexpected(size + " is more than the graphics driver's " + std::to_string(most_px) +
                           " px each way");
  }
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) {
  }  // earlier ones are not ours
  RenderTarget target;
  target.width_px = width_px;
  target.height_px = height_px;
  target.colour = gl::makeTexture(format, static_cast<GLsizei>(width_px),
                                  static_cast<GLsizei>(height_px), GL_LINEAR, GL_CLAMP_TO_EDGE);
  target.framebuffer = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.colour.get(),
                         0);
  if (glGetError() != GL_NO_ERROR ||
      glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return std::unexpected("the graphics driver has no picture of " + size + " to draw into");
  }
  return target;
}

rt::Result<void> readTarget(const RenderTarget& target, Orientation orientation,
                            std::span<std::byte> scratch, std::span<std::byte> rgba) {
  if (rgba.size() != std::size_t{4} * target.width_px * target.height_px) {
    return std::unexpected(rt::Error{rt::Errc::kInvalidConfig, 0, "read: size of the buffer"});
  }
  const std::span<std::byte> into = orientation.upright() ? rgba : scratch;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px),
               GL_RGBA, GL_UNSIGNED_BYTE, into.data());
  if (orientation.upright()) return {};
  const SizePx picture = orientation.turned(SizePx{target.width_px, target.height_px});
  for (std::uint32_t i = 0; i < picture.width * picture.height; ++i) {
    const auto x = static_cast<std::int32_t>(i % picture.width);
    const auto y = static_cast<std::int32_t>(i / picture.width);
    const hal::RectPx from = orientation.turned(hal::RectPx{x, y, 1, 1}, picture);
    const auto at =
        static_cast<std::size_t>(from.y) * target.width_px + static_cast<std::size_t>(from.x);
    std::memcpy(&rgba[std::size_t{4} * i], &scratch[4 * at], 4);
  }
  return {};
}

}  // namespace ui
