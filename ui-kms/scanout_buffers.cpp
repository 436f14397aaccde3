#include "ui-kms/scanout_buffers.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2ext.h>
#include <drm_fourcc.h>
#include <gbm.h>

namespace ui {
namespace {

std::unexpected<std::string> failed(const char* what, const char* why) {
  return std::unexpected(std::string(what) + ": " + why);
}

kms::FramebufferLayout layoutOf(gbm_bo* bo) {
  kms::FramebufferLayout layout;
  layout.width_px = gbm_bo_get_width(bo);
  layout.height_px = gbm_bo_get_height(bo);
  layout.format = gbm_bo_get_format(bo);
  layout.modifier = gbm_bo_get_modifier(bo);
  layout.has_modifier = layout.modifier != DRM_FORMAT_MOD_INVALID;
  for (int i = 0; i < gbm_bo_get_plane_count(bo) && i < 4; ++i) {
    const auto plane = static_cast<std::size_t>(i);
    layout.handles[plane] = gbm_bo_get_handle_for_plane(bo, i).u32;
    layout.pitches[plane] = gbm_bo_get_stride_for_plane(bo, i);
    layout.offsets[plane] = gbm_bo_get_offset(bo, i);
  }
  return layout;
}

}  // namespace

void ScanoutBuffers::CloseBo::operator()(gbm_bo* bo) const {
  gbm_bo_destroy(bo);
}

void ScanoutBuffers::CloseImage::operator()(void* image) const {
  eglDestroyImage(display, image);
}

std::expected<ScanoutBuffers, std::string> ScanoutBuffers::create(
    int fd, gbm_device* gbm, const gl::Context& context, ScanoutPath path, std::uint32_t width_px,
    std::uint32_t height_px, std::uint32_t count) {
  ScanoutBuffers made;
  for (std::uint32_t i = 0; i < count; ++i) {
    auto buffer = path == ScanoutPath::kDirect ? makeDirect(fd, gbm, context, width_px, height_px)
                                               : makeCopied(fd, width_px, height_px);
    if (!buffer) return std::unexpected(buffer.error());
    made.buffers_.push_back(std::move(*buffer));
  }
  return made;
}

std::expected<ScanoutBuffers::Buffer, std::string> ScanoutBuffers::makeDirect(
    int fd, gbm_device* gbm, const gl::Context& context, std::uint32_t width_px,
    std::uint32_t height_px) {
  Buffer buffer;
  buffer.bo.reset(gbm_bo_create(gbm, width_px, height_px, GBM_FORMAT_XRGB8888,
                                GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING));
  if (!buffer.bo) return failed("no GBM buffer for the screen", std::strerror(errno));
  auto framebuffer = kms::Framebuffer::create(fd, layoutOf(buffer.bo.get()));
  if (!framebuffer) return failed("no framebuffer", std::strerror(framebuffer.error()));
  buffer.framebuffer = std::move(*framebuffer);

  const auto create_image =
      reinterpret_cast<PFNEGLCREATEIMAGEKHRPROC>(eglGetProcAddress("eglCreateImageKHR"));
  const auto bind_image = reinterpret_cast<PFNGLEGLIMAGETARGETRENDERBUFFERSTORAGEOESPROC>(
      eglGetProcAddress("glEGLImageTargetRenderbufferStorageOES"));
  if (create_image == nullptr || bind_image == nullptr) {
    return failed("no import of GBM buffers", "EGL_KHR_image or GL_OES_EGL_image is missing");
  }
  void* image = create_image(context.display(), EGL_NO_CONTEXT, EGL_NATIVE_PIXMAP_KHR,
                             static_cast<EGLClientBuffer>(buffer.bo.get()), nullptr);
  if (image == EGL_NO_IMAGE_KHR) return failed("no import of GBM buffers", "EGL refused it");
  buffer.image = {image, CloseImage{context.display()}};

  buffer.renderbuffer = gl::makeRenderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.renderbuffer.get());
  bind_image(GL_RENDERBUFFER, image);
  buffer.target.width_px = width_px;
  buffer.target.height_px = height_px;
  buffer.target.framebuffer = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, buffer.target.framebuffer.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            buffer.renderbuffer.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return failed("no import of GBM buffers", "GL cannot draw into them");
  }
  return buffer;
}

std::expected<ScanoutBuffers::Buffer, std::string> ScanoutBuffers::makeCopied(
    int fd, std::uint32_t width_px, std::uint32_t height_px) {
  auto dumb = kms::DumbBuffer::create(fd, width_px, height_px);
  if (!dumb) return failed("no memory of the card", std::strerror(dumb.error()));
  Buffer buffer;
  buffer.dumb = std::move(*dumb);
  auto framebuffer = kms::Framebuffer::create(fd, buffer.dumb.layout());
  if (!framebuffer) return failed("no framebuffer", std::strerror(framebuffer.error()));
  buffer.framebuffer = std::move(*framebuffer);
  auto target = makeRenderTarget(width_px, height_px);
  if (!target) return std::unexpected(target.error());
  buffer.target = std::move(*target);
  return buffer;
}

void ScanoutBuffers::finishDraw(std::uint32_t index) {
  Buffer& buffer = buffers_[index];
  if (buffer.dumb.bytes().empty()) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, buffer.target.framebuffer.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(buffer.dumb.pitch() / 4));
  glReadPixels(0, 0, static_cast<GLsizei>(buffer.target.width_px),
               static_cast<GLsizei>(buffer.target.height_px), GL_BGRA_EXT, GL_UNSIGNED_BYTE,
               buffer.dumb.bytes().data());
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

}  // namespace ui
