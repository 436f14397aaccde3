#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "hal/display.h"
#include "hal/gl/objects.h"
#include "ui-kms/glyph_atlas.h"

namespace ui {

/// Draws the status line over the picture: light letters on a soft dark plate; a warning is a
/// badge, dark letters on amber. The letters are 1/18 of the picture's height.
///
/// Threads  The one that has the context.
/// Memory   A changed text is laid out once; an unchanged one costs a draw call.
/// Errors   create(): no font, in one line; the picture can go on without text.
class StatusLinePass {
 public:
  [[nodiscard]] static std::expected<StatusLinePass, std::string> create(
      const std::string& font_path, std::uint32_t width_px, std::uint32_t height_px);

  /// Over the bound framebuffer. An empty line draws nothing.
  void draw(const hal::StatusLine& status);

 private:
  struct Vertex {
    float x_px, y_px;  // display, top left is 0,0
    float u, v;        // atlas, or the plate's own coordinates in pixels from its centre
  };
  StatusLinePass(GlyphAtlas atlas, std::uint32_t width_px, std::uint32_t height_px);
  void makeBuffers();
  void layOut(const hal::StatusLine& status);
  void addQuad(float left, float top, float right, float bottom, float u0, float v0, float u1,
               float v1);

  GlyphAtlas atlas_;
  float width_px_;
  float height_px_;
  gl::Program program_;
  gl::Texture texture_;
  gl::VertexArray layout_;
  gl::Buffer buffer_;
  GLint colour_at_ = -1;
  GLint plate_at_ = -1;  // half size, corner radius, softness; zero for letters

  std::optional<hal::StatusLine> laid_out_;
  std::vector<PlacedGlyph> glyphs_;
  std::vector<Vertex> corners_;  // the plate's six, then six per letter
  float plate_half_width_px_ = 0;
  float plate_half_height_px_ = 0;
};

}  // namespace ui
