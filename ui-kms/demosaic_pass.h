#pragma once

#include <expected>
#include <string>

#include "hal/display.h"
#include "hal/gl/objects.h"
#include "ui-kms/render_target.h"

namespace ui {

/// Full colour by the gradient-corrected 5x5 filters of Malvar, He and Cutler ("High-quality
/// linear interpolation for demosaicing of Bayer-patterned color images", 2004), for a GPU.
///
/// Threads  The one that has the context.
class DemosaicPass {
 public:
  [[nodiscard]] static std::expected<DemosaicPass, std::string> create();

  /// @p mosaic: R8, the size of @p target. Linear light in and out.
  void draw(GLuint mosaic, hal::PixelFormat format, const RenderTarget& target);

 private:
  DemosaicPass() = default;

  gl::Program program_;
  gl::VertexArray no_attributes_;
  GLint red_at_ = -1;
  GLint mono_ = -1;
};

}  // namespace ui
