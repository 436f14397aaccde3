#pragma once

#include <expected>
#include <string>
#include <utility>

#include <GLES3/gl3.h>

namespace gl {

/// A GL name that is deleted with its owner. The context must be current then; without one the
/// deletion is the context's own end.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  ~Handle() {
    if (name_ != 0) Delete(name_);
  }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
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

using Texture = Handle<deleteTexture>;
using Buffer = Handle<deleteBuffer>;
using Framebuffer = Handle<deleteFramebuffer>;
using Renderbuffer = Handle<deleteRenderbuffer>;
using Program = Handle<deleteProgram>;
using VertexArray = Handle<deleteVertexArray>;

[[nodiscard]] Buffer makeBuffer();
[[nodiscard]] Framebuffer makeFramebuffer();
[[nodiscard]] Renderbuffer makeRenderbuffer();
[[nodiscard]] VertexArray makeVertexArray();

/// Immutable storage of @p levels mipmap levels; @p format is a sized internal format. The texture
/// stays bound. A filter between levels serves for making smaller; larger it is GL_LINEAR.
[[nodiscard]] Texture makeTexture(GLenum format, GLsizei width_px, GLsizei height_px, GLint filter,
                                  GLint wrap, int levels = 1);

/// Compiles and links; the error names the pass and carries the driver's message.
[[nodiscard]] std::expected<Program, std::string> makeProgram(const char* pass,
                                                              const std::string& vertex,
                                                              const std::string& fragment);

/// Where a uniform of the program is; -1 when the compiler found no use for it.
[[nodiscard]] GLint uniform(const Program& program, const char* name);

}  // namespace gl
