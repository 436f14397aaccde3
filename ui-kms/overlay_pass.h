#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "hal/gl/objects.h"
#include "hal/overlay.h"
#include "ui-kms/glyph_store.h"
#include "ui-kms/orientation.h"

namespace ui {

/// Draws an overlay over the finished picture, in one call: letters from the glyph store, marks by
/// their distance from the pixel.
///
/// Threads  The one that has the context; it is the glyph store's drawing thread.
/// Memory   Room for a whole overlay and all pages is made by create(). A changed overlay is
///          uploaded once, with the letters that are new; an unchanged one costs a draw call.
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
  void makeBuffers();
  void take(const hal::Overlay& overlay);
  void upload(const GlyphStore::Place& letter);

  GlyphStore* store_;
  gl::Program program_;
  gl::Texture pages_;
  gl::VertexArray layout_;
  gl::Buffer items_;
  GLint picture_px_at_ = -1;
  GLint turn_at_ = -1;

  std::uint64_t generation_ = 0;  // of what is in items_
  GLsizei count_ = 0;
  std::uint64_t uploaded_ = 0;  // letters
};

}  // namespace ui
