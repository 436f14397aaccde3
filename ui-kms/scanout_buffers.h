#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "hal/gl/context.h"
#include "hal/gl/objects.h"
#include "ui-kms/kms/framebuffer.h"
#include "ui-kms/render_target.h"

struct gbm_device;
struct gbm_bo;

namespace ui {

/// How pictures get into memory that the screen can show.
enum class ScanoutPath : std::uint8_t {
  kDirect,  ///< GL draws into it: GBM buffers, imported as EGL images
  kCopied,  ///< GL draws elsewhere and the CPU copies: dumb buffers, which every driver has
};

/// The buffers of one screen at one size.
///
/// Threads  The one that has the context, also at the end.
/// Memory   All of it is made by create().
class ScanoutBuffers {
 public:
  /// @p gbm: of the card @p fd, for kDirect; both outlive the buffers.
  /// Errors: one line.
  [[nodiscard]] static std::expected<ScanoutBuffers, std::string> create(
      int fd, gbm_device* gbm, const gl::Context& context, ScanoutPath path, std::uint32_t width_px,
      std::uint32_t height_px, std::uint32_t count);

  [[nodiscard]] std::uint32_t widthPx() const { return buffers_.front().target.width_px; }
  [[nodiscard]] std::uint32_t heightPx() const { return buffers_.front().target.height_px; }
  [[nodiscard]] const RenderTarget& target(std::uint32_t buffer) const {
    return buffers_[buffer].target;
  }
  [[nodiscard]] std::uint32_t framebuffer(std::uint32_t buffer) const {
    return buffers_[buffer].framebuffer.id();
  }
  /// After drawing: copies the pixels to where the screen reads them, if they are not there.
  void finishDraw(std::uint32_t buffer);

 private:
  struct CloseBo {
    void operator()(gbm_bo* bo) const;
  };
  struct CloseImage {
    void* display;  // EGLDisplay
    void operator()(void* image) const;
  };
  // In this order, so that what reads memory ends before the memory.
  struct Buffer {
    std::unique_ptr<gbm_bo, CloseBo> bo;
    kms::DumbBuffer dumb;
    kms::Framebuffer framebuffer;
    std::unique_ptr<void, CloseImage> image;
    gl::Renderbuffer renderbuffer;
    RenderTarget target;
  };
  [[nodiscard]] static std::expected<Buffer, std::string> makeDirect(int fd, gbm_device* gbm,
                                                                     const gl::Context& context,
                                                                     std::uint32_t width_px,
                                                                     std::uint32_t height_px);
  [[nodiscard]] static std::expected<Buffer, std::string> makeCopied(int fd, std::uint32_t width_px,
                                                                     std::uint32_t height_px);

  std::vector<Buffer> buffers_;
};

}  // namespace ui
