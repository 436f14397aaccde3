#include "ui-kms/overlay_pass.h"

#include <array>
#include <cstddef>
#include <utility>

namespace ui {
namespace {

// One instance per item. at: where the pixel is, in the item's own pixels. A letter is drawn in its
// own size, so a pixel of it is one of its page.
constexpr const char* kVertex = R"(#version 300 es
layout(location = 0) in uvec2 kind_page;
layout(location = 1) in uvec2 from_px;
layout(location = 2) in vec4 rgba;
layout(location = 3) in vec4 box;
layout(location = 4) in vec2 radius_stroke;
uniform vec2 picture_px;
uniform mat2 turn;
flat out uint kind;
flat out float page;
flat out vec4 tint;
flat out vec2 half_px;
flat out vec2 form;
out vec2 at;
void main() {
  kind = kind_page.x;
  page = float(kind_page.y);
  tint = rgba;
  form = radius_stroke;
  half_px = box.zw * 0.5;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 p = box.xy + corner * box.zw;
  if (kind == 0u) {
    at = vec2(from_px) + corner * box.zw;
  } else if (kind == 3u) {
    float reach = radius_stroke.y * 0.5 + 1.0;
    float long_px = max(length(box.zw), 1e-3);
    vec2 along = box.zw / long_px;
    vec2 across = vec2(-along.y, along.x);
    at = vec2(corner.x * long_px, (corner.y * 2.0 - 1.0) * reach);
    p = box.xy + along * at.x + across * at.y;
  } else {
    at = (corner - 0.5) * box.zw;
  }
  gl_Position = vec4(turn * (p / picture_px * 2.0 - 1.0), 0.0, 1.0);
}
)";

constexpr const char* kLetter = R"(#version 300 es
precision highp float;
precision highp sampler2DArray;
uniform sampler2DArray pages;
flat in float page;
flat in vec4 tint;
in vec2 at;
out vec4 colour;
void main() {
  colour = vec4(tint.rgb, tint.a * texelFetch(pages, ivec3(ivec2(at), int(page)), 0).r);
}
)";

constexpr const char* kMark = R"(#version 300 es
precision highp float;
flat in uint kind;
flat in vec4 tint;
flat in vec2 half_px;
flat in vec2 form;
in vec2 at;
out vec4 colour;
void main() {
  vec2 beyond = abs(at) - half_px + form.x;
  float rim = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - form.x;
  float cover = kind == 1u   ? 1.0 - smoothstep(-max(form.y, 0.01), 0.0, rim)
                : kind == 2u ? clamp(form.y * 0.5 + 0.5 - abs(rim + form.y * 0.5), 0.0, 1.0)
                             : clamp(form.y * 0.5 + 0.5 - abs(at.y), 0.0, 1.0);
  colour = vec4(tint.rgb, tint.a * cover);
}
)";

constexpr GLsizei kStride = sizeof(hal::OverlayItem);

}  // namespace

std::expected<OverlayPass::Program, std::string> OverlayPass::makeProgram(const char* pass,
                                                                          const char* fragment) {
  auto made = gl::makeProgram(pass, kVertex, fragment);
  if (!made) return std::unexpected(made.error());
  Program program;
  program.program = std::move(*made);
  program.picture_px = uniform(program.program, "picture_px");
  program.turn = uniform(program.program, "turn");
  return program;
}

std::expected<OverlayPass, std::string> OverlayPass::create(GlyphStore& store) {
  OverlayPass pass(store);
  auto letters = makeProgram("letters", kLetter);
  if (!letters) return std::unexpected(letters.error());
  pass.letters_ = std::move(*letters);
  auto marks = makeProgram("marks", kMark);
  if (!marks) return std::unexpected(marks.error());
  pass.marks_ = std::move(*marks);
  pass.makeBuffers();
  return pass;
}

void OverlayPass::makeBuffers() {
  GLuint pages = 0;
  glGenTextures(1, &pages);
  pages_ = gl::Texture(pages);
  glBindTexture(GL_TEXTURE_2D_ARRAY, pages);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_R8, GlyphStore::kPagePx, GlyphStore::kPagePx,
                 GlyphStore::kMostPages);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);

  runs_.reserve(hal::Overlay::kMostItems);
  layout_ = gl::makeVertexArray();
  items_ = gl::makeBuffer();
  glBindVertexArray(layout_.get());
  glBindBuffer(GL_ARRAY_BUFFER, items_.get());
  glBufferData(GL_ARRAY_BUFFER, sizeof(hal::Overlay::items), nullptr, GL_DYNAMIC_DRAW);
  for (GLuint attribute = 0; attribute < 5; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribDivisor(attribute, 1);
  }
}

/// The attributes of the items from @p first on.
void OverlayPass::point(std::uint32_t first) {
  using Item = hal::OverlayItem;
  static_assert(offsetof(Item, page) == offsetof(Item, kind) + 1);
  const auto from = [first](std::size_t member) {
    return reinterpret_cast<const void*>(first * sizeof(Item) + member);
  };
  glVertexAttribIPointer(0, 2, GL_UNSIGNED_BYTE, kStride, from(offsetof(Item, kind)));
  glVertexAttribIPointer(1, 2, GL_UNSIGNED_SHORT, kStride, from(offsetof(Item, u_px)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, from(offsetof(Item, colour)));
  glVertexAttribPointer(3, 4, GL_FLOAT, GL_FALSE, kStride, from(offsetof(Item, x_px)));
  glVertexAttribPointer(4, 2, GL_FLOAT, GL_FALSE, kStride, from(offsetof(Item, radius_px)));
}

void OverlayPass::resize(SizePx picture, Orientation orientation) {
  const auto right = orientation.turned(1, 0);
  const auto down = orientation.turned(0, 1);
  const std::array<float, 4> turn = {right[0], right[1], down[0], down[1]};  // by columns
  for (const Program* program : {&letters_, &marks_}) {
    glUseProgram(program->program.get());
    glUniform2f(program->picture_px, static_cast<float>(picture.width),
                static_cast<float>(picture.height));
    glUniformMatrix2fv(program->turn, 1, GL_FALSE, turn.data());
  }
}

void OverlayPass::draw(const hal::Overlay& overlay) {
  if (overlay.generation != generation_) take(overlay);
  if (runs_.empty()) return;
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, pages_.get());
  glBindVertexArray(layout_.get());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBindBuffer(GL_ARRAY_BUFFER, items_.get());
  for (const Run& run : runs_) {
    glUseProgram((run.letters ? letters_ : marks_).program.get());
    point(run.first);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, run.count);
  }
  glDisable(GL_BLEND);
}

/// At most as many letters are new as the store's ring holds.
void OverlayPass::take(const hal::Overlay& overlay) {
  while (uploaded_ < overlay.glyphs) {
    const auto letter = store_->tryPopUpload();
    if (!letter) break;
    upload(*letter);
    ++uploaded_;
  }
  glBindBuffer(GL_ARRAY_BUFFER, items_.get());
  glBufferSubData(GL_ARRAY_BUFFER, 0,
                  static_cast<GLsizeiptr>(overlay.count * sizeof(hal::OverlayItem)),
                  overlay.items.data());
  runs_.clear();
  for (std::uint32_t i = 0; i < overlay.count; ++i) {
    const bool letters = overlay.items[i].kind == hal::OverlayItem::Kind::kGlyph;
    if (runs_.empty() || runs_.back().letters != letters)
      runs_.push_back({.first = i, .letters = letters});
    ++runs_.back().count;
  }
  generation_ = overlay.generation;
  store_->adopt(generation_);
}

void OverlayPass::upload(const GlyphStore::Place& letter) {
  const auto pixels = store_->pixels(letter.page);
  glBindTexture(GL_TEXTURE_2D_ARRAY, pages_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, GlyphStore::kPagePx);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, letter.u_px, letter.v_px, letter.page, letter.width_px,
                  letter.height_px, 1, GL_RED, GL_UNSIGNED_BYTE,
                  &pixels[std::size_t{GlyphStore::kPagePx} * letter.v_px + letter.u_px]);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace ui
