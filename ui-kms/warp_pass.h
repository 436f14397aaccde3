#pragma once

#include <expected>
#include <string>

#include "hal/display.h"
#include "hal/gl/objects.h"
#include "ui-kms/warp_mesh.h"

namespace ui {

/// Draws one view: backward map, bilinear in linear light, colour gains, sRGB encoding.
///
/// Threads  The one that has the context.
class WarpPass {
 public:
  [[nodiscard]] static std::expected<WarpPass, std::string> create(std::uint32_t width_px,
                                                                   std::uint32_t height_px);

  /// Into the bound framebuffer. @p source: demosaiced, linear light, the plan's source size.
  void draw(const hal::WarpPlan& plan, GLuint source);

 private:
  WarpPass(std::uint32_t width_px, std::uint32_t height_px) : mesh_(width_px, height_px) {}
  void makeBuffers();
  void drawInner(const hal::WarpPlan& plan);
  void drawEdge(const hal::WarpPlan& plan);

  struct InnerUniforms {
    GLint gain_rgb = -1;
  };
  struct EdgeUniforms {
    GLint gain_rgb = -1, focal_px = -1, centre_px = -1, radial = -1, tangential = -1;
    GLint max_radius2 = -1, source_px = -1;
  };

  WarpMesh mesh_;
  gl::Program inner_;
  gl::Program edge_;
  InnerUniforms inner_at_;
  EdgeUniforms edge_at_;
  gl::VertexArray layout_;
  gl::Buffer positions_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
};

}  // namespace ui
