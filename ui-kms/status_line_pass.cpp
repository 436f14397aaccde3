#include "ui-kms/status_line_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace ui {
namespace {

constexpr float kLinesPerPicture = 18;  // readable from five metres on a 65 inch screen
constexpr std::size_t kCornersPerQuad = 6;
constexpr std::size_t kMostQuads = 1 + std::tuple_size_v<decltype(hal::StatusLine::text)>;

constexpr const char* kVertex = R"(#version 300 es
layout(location = 0) in vec4 position_texture;
uniform vec2 display_px;
out vec2 at;
void main() {
  at = position_texture.zw;
  gl_Position = vec4(position_texture.xy / display_px * 2.0 - 1.0, 0.0, 1.0);
}
)";

// plate: half width, half height, corner radius, softness of the rim, all in pixels.
constexpr const char* kFragment = R"(#version 300 es
precision highp float;
uniform sampler2D atlas;
uniform vec4 text_colour;
uniform vec4 plate;
in vec2 at;
out vec4 colour;
void main() {
  float coverage;
  if (plate.x > 0.0) {
    vec2 beyond = abs(at) - plate.xy + plate.z;
    float rim = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - plate.z;
    coverage = 1.0 - smoothstep(-plate.w, 0.0, rim);
  } else {
    coverage = texture(atlas, at).r;
  }
  colour = vec4(text_colour.rgb, text_colour.a * coverage);
}
)";

using Colour = std::array<float, 4>;
constexpr Colour kLetters = {0.97F, 0.97F, 0.95F, 1.0F};
constexpr Colour kPlate = {0.03F, 0.04F, 0.05F, 0.62F};
constexpr Colour kBadgeLetters = {0.08F, 0.05F, 0.0F, 1.0F};
constexpr Colour kBadgePlate = {1.0F, 0.70F, 0.10F, 0.94F};

std::uint32_t emPx(std::uint32_t height_px) {
  return std::max(8U, static_cast<std::uint32_t>(static_cast<float>(height_px) / kLinesPerPicture));
}

}  // namespace

StatusLinePass::StatusLinePass(GlyphAtlas atlas, std::uint32_t width_px, std::uint32_t height_px)
    : atlas_(std::move(atlas)),
      width_px_(static_cast<float>(width_px)),
      height_px_(static_cast<float>(height_px)) {
  glyphs_.reserve(kMostQuads);
  corners_.reserve(kMostQuads * kCornersPerQuad);
}

std::expected<StatusLinePass, std::string> StatusLinePass::create(const std::string& font_path,
                                                                  std::uint32_t width_px,
                                                                  std::uint32_t height_px) {
  auto atlas = GlyphAtlas::create(font_path, emPx(height_px));
  if (!atlas) return std::unexpected(atlas.error());
  auto program = gl::makeProgram("status line", kVertex, kFragment);
  if (!program) return std::unexpected(program.error());
  StatusLinePass pass(std::move(*atlas), width_px, height_px);
  pass.program_ = std::move(*program);
  pass.makeBuffers();
  return pass;
}

void StatusLinePass::makeBuffers() {
  texture_ = gl::makeTexture(GL_R8, static_cast<GLsizei>(atlas_.widthPx()),
                             static_cast<GLsizei>(atlas_.heightPx()), GL_LINEAR, GL_CLAMP_TO_EDGE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(atlas_.widthPx()),
                  static_cast<GLsizei>(atlas_.heightPx()), GL_RED, GL_UNSIGNED_BYTE,
                  atlas_.pixels().data());
  layout_ = gl::makeVertexArray();
  buffer_ = gl::makeBuffer();
  glBindVertexArray(layout_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.capacity() * sizeof(Vertex)),
               nullptr, GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  colour_at_ = uniform(program_, "text_colour");
  plate_at_ = uniform(program_, "plate");
  glUseProgram(program_.get());
  glUniform2f(uniform(program_, "display_px"), width_px_, height_px_);
}

void StatusLinePass::addQuad(float left, float top, float right, float bottom, float u0, float v0,
                             float u1, float v1) {
  const Vertex a{left, top, u0, v0};
  const Vertex b{right, top, u1, v0};
  const Vertex c{left, bottom, u0, v1};
  const Vertex d{right, bottom, u1, v1};
  corners_.insert(corners_.end(), {a, b, c, b, d, c});
}

void StatusLinePass::layOut(const hal::StatusLine& status) {
  laid_out_ = status;
  corners_.clear();
  const float text_width_px = atlas_.shape(status.view(), glyphs_);
  if (glyphs_.empty()) return;
  const float margin_px = height_px_ / 36;
  const float padding_px = height_px_ / 40;
  // A line too long for the picture is drawn smaller, never cut.
  const float room_px = width_px_ - 2 * (margin_px + padding_px);
  const float scale = std::min(1.0F, room_px / text_width_px);
  const float cap_px = atlas_.capHeightPx() * scale;

  const float left_px = margin_px;
  const float right_px = margin_px + 2 * padding_px + text_width_px * scale;
  const float bottom_px = height_px_ - margin_px;
  const float top_px = bottom_px - cap_px - 2 * padding_px;
  plate_half_width_px_ = (right_px - left_px) / 2;
  plate_half_height_px_ = (bottom_px - top_px) / 2;
  addQuad(left_px, top_px, right_px, bottom_px, -plate_half_width_px_, -plate_half_height_px_,
          plate_half_width_px_, plate_half_height_px_);

  const float pen_px = left_px + padding_px;
  const float baseline_px = bottom_px - padding_px;
  const auto atlas_width_px = static_cast<float>(atlas_.widthPx());
  const auto atlas_height_px = static_cast<float>(atlas_.heightPx());
  for (const PlacedGlyph& glyph : glyphs_) {
    if (corners_.size() + kCornersPerQuad > corners_.capacity()) break;
    const float x_px = pen_px + glyph.x_px * scale;
    const float y_px = baseline_px + glyph.y_px * scale;
    const float u = static_cast<float>(glyph.atlas_x) / atlas_width_px;
    const float v = static_cast<float>(glyph.atlas_y) / atlas_height_px;
    addQuad(x_px, y_px, x_px + glyph.width_px * scale, y_px + glyph.height_px * scale, u, v,
            u + glyph.width_px / atlas_width_px, v + glyph.height_px / atlas_height_px);
  }
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(corners_.size() * sizeof(Vertex)),
                  corners_.data());
}

void StatusLinePass::draw(const hal::StatusLine& status) {
  if (!laid_out_ || laid_out_->view() != status.view()) layOut(status);
  if (corners_.empty()) return;
  const Colour& plate = status.warning ? kBadgePlate : kPlate;
  const Colour& letters = status.warning ? kBadgeLetters : kLetters;
  glUseProgram(program_.get());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glBindVertexArray(layout_.get());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUniform4fv(colour_at_, 1, plate.data());
  glUniform4f(plate_at_, plate_half_width_px_, plate_half_height_px_, plate_half_height_px_ * 0.5F,
              plate_half_height_px_ * 0.15F);
  glDrawArrays(GL_TRIANGLES, 0, kCornersPerQuad);
  glUniform4fv(colour_at_, 1, letters.data());
  glUniform4f(plate_at_, 0, 0, 0, 0);
  glDrawArrays(GL_TRIANGLES, kCornersPerQuad,
               static_cast<GLsizei>(corners_.size() - kCornersPerQuad));
  glDisable(GL_BLEND);
}

}  // namespace ui
