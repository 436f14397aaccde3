#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <utility>

#include <GLES3/gl3.h>

#include "rt/result.h"

namespace ui {

/// A GL name that is deleted with its owner. The context must be current then; without one the
/// deletion is the context's own end.
template <void (*Delete)(GLuint)>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(GLuint name) : name_(name) {}
  ~GlHandle() {
    if (name_ != 0) Delete(name_);
  }
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  [[nodiscard]] GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

void deleteTexture(GLuint name);
void deleteBuffer(GLuint name);
void deleteFramebuffer(GLuint name);
void deleteRenderbuffer(GLuint name);
void deleteProgram(GLuint name);
void deleteVertexArray(GLuint name);

using GlTexture = GlHandle<deleteTexture>;
using GlBuffer = GlHandle<deleteBuffer>;
using GlFramebuffer = GlHandle<deleteFramebuffer>;
using GlRenderbuffer = GlHandle<deleteRenderbuffer>;
using GlProgram = GlHandle<deleteProgram>;
using GlVertexArray = GlHandle<deleteVertexArray>;

[[nodiscard]] GlBuffer makeBuffer();
[[nodiscard]] GlFramebuffer makeFramebuffer();
[[nodiscard]] GlRenderbuffer makeRenderbuffer();
[[nodiscard]] GlVertexArray makeVertexArray();

/// Immutable storage of one level; @p format is a sized internal format.
[[nodiscard]] GlTexture makeTexture(GLenum format, std::uint32_t width_px, std::uint32_t height_px,
                                    GLint filter, GLint wrap);

/// A picture to draw into. Row 0 is the picture's top row, as scanout wants it.
struct RenderTarget {
  GlTexture colour;  ///< none where the framebuffer draws into other memory
  GlFramebuffer framebuffer;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
};
[[nodiscard]] RenderTarget makeRenderTarget(std::uint32_t width_px, std::uint32_t height_px);
/// RGBA bytes, top row first. Errors: kInvalidConfig, @p rgba has another size.
[[nodiscard]] rt::Result<void> readTarget(const RenderTarget& target, std::span<std::byte> rgba);

/// Compiles and links; the error names the pass and carries the driver's message.
[[nodiscard]] std::expected<GlProgram, std::string> makeProgram(const char* pass,
                                                                const std::string& vertex,
                                                                const std::string& fragment);

}  // namespace ui
