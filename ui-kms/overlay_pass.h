#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "hal/gl/objects.h"
#include "hal/overlay.h"
#include "ui-kms/glyph_store.h"
#include "ui-kms/orientation.h"

namespace ui {

/// Draws an overlay over the finished picture: letters from the glyph store, marks by their
/// distance from the pixel. Each has a program of its own, because a software renderer pays for
/// both sides of a branch; a call draws as many of one kind as follow each other.
///
/// Threads  The one that has the context; it is the glyph store's drawing thread.
/// Memory   Room for a whole overlay and all pages is made by create(). A changed overlay is
///          uploaded once, with the letters that are new; an unchanged one costs its draw calls.
class OverlayPass {
 public:
  /// @p store outlives this.
  [[nodiscard]] static std::expected<OverlayPass, std::string> create(GlyphStore& store);

  /// @p picture: upright.
  void resize(SizePx picture, Orientation orientation);

  /// Over the bound framebuffer.
  void draw(const hal::Overlay& overlay);

 private:
  explicit OverlayPass(GlyphStore& store) : store_(&store) {}
  struct Program {
    gl::Program program;
    GLint picture_px = -1;
    GLint turn = -1;
  };
  struct Run {  // of items
    std::uint32_t first = 0;
    GLsizei count = 0;
    bool letters = false;
  };
  [[nodiscard]] static std::expected<Program, std::string> makeProgram(const char* pass,
                                                                       const char* fragment);
  void makeBuffers();
  void point(std::uint32_t first);
  void take(const hal::Overlay& overlay);
  void upload(const GlyphStore::Place& letter);

  GlyphStore* store_;
  Program letters_;
  Program marks_;
  gl::Texture pages_;
  gl::VertexArray layout_;
  gl::Buffer items_;

  std::uint64_t generation_ = 0;  // of what is in items_
  std::vector<Run> runs_;
  std::uint64_t uploaded_ = 0;  // letters
};

}  // namespace ui
