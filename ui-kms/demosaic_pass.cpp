#include "ui-kms/demosaic_pass.h"

namespace ui {
namespace {

constexpr const char* kVertex = R"(#version 300 es
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);  // one triangle covers all
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

// red_at: the parity (x, y) of the red pixels. Beyond the picture the mosaic is mirrored about
// its outermost pixels, which keeps the colours of the pattern.
constexpr const char* kFragment = R"(#version 300 es
precision highp float;
uniform sampler2D mosaic;
uniform ivec2 red_at;
uniform bool mono;
out vec4 colour;
ivec2 size, here;
float at(int dx, int dy) {
  ivec2 last = size - 1;
  return texelFetch(mosaic, last - abs(last - abs(here + ivec2(dx, dy))), 0).r;
}
void main() {
  size = textureSize(mosaic, 0);
  here = ivec2(gl_FragCoord.xy);
  float centre = at(0, 0);
  if (mono) {
    colour = vec4(vec3(centre), 1.0);
    return;
  }
  float sides = at(-1, 0) + at(1, 0);
  float poles = at(0, -1) + at(0, 1);
  float corners = at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1);
  float far_sides = at(-2, 0) + at(2, 0);
  float far_poles = at(0, -2) + at(0, 2);
  float cross = (4.0 * centre + 2.0 * (sides + poles) - far_sides - far_poles) / 8.0;
  float diagonal = (6.0 * centre + 2.0 * corners - 1.5 * (far_sides + far_poles)) / 8.0;
  float along_row =
      (5.0 * centre + 4.0 * sides - corners - far_sides + 0.5 * far_poles) / 8.0;
  float along_column =
      (5.0 * centre + 4.0 * poles - corners - far_poles + 0.5 * far_sides) / 8.0;
  ivec2 parity = (here + red_at) & 1;
  vec3 rgb = parity == ivec2(0, 0)   ? vec3(centre, cross, diagonal)
             : parity == ivec2(1, 1) ? vec3(diagonal, cross, centre)
             : parity.y == 0         ? vec3(along_row, centre, along_column)
                                     : vec3(along_column, centre, along_row);
  colour = vec4(rgb, 1.0);
}
)";

struct Parity {
  GLint x, y;
};

Parity redAt(hal::PixelFormat format) {
  switch (format) {
    case hal::PixelFormat::kBayerGR8:
      return {1, 0};
    case hal::PixelFormat::kBayerGB8:
      return {0, 1};
    case hal::PixelFormat::kBayerBG8:
      return {1, 1};
    case hal::PixelFormat::kBayerRG8:
    case hal::PixelFormat::kMono8:
      break;
  }
  return {0, 0};
}

}  // namespace

std::expected<DemosaicPass, std::string> DemosaicPass::create() {
  auto program = gl::makeProgram("demosaic", kVertex, kFragment);
  if (!program) return std::unexpected(program.error());
  DemosaicPass pass;
  pass.program_ = std::move(*program);
  pass.no_attributes_ = gl::makeVertexArray();
  pass.red_at_ = uniform(pass.program_, "red_at");
  pass.mono_ = uniform(pass.program_, "mono");
  return pass;
}

void DemosaicPass::draw(GLuint mosaic, hal::PixelFormat format, const RenderTarget& target) {
  const auto [x, y] = redAt(format);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glViewport(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px));
  glUseProgram(program_.get());
  glUniform2i(red_at_, x, y);
  glUniform1i(mono_, format == hal::PixelFormat::kMono8 ? 1 : 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, mosaic);
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace ui
