#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <utility>

#include <GLES3/gl3.h>

namespace emulator::studio {

/// A drawing context without window or screen.
///
/// Threads  Current on the thread that made it until it is destroyed, there.
/// Errors   Says in one line what is missing on a machine without EGL or OpenGL ES 3.
class GlContext {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<GlContext>, std::string> create();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// The driver's name: pictures are the same bit for bit only with the same one.
  [[nodiscard]] const std::string& renderer() const { return renderer_; }

 private:
  GlContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;
  void* context_;
  std::string renderer_;
};

/// A GL name that is deleted with its owner, while its context is current.
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
/// Immutable storage; @p levels of it.
[[nodiscard]] GlTexture makeTexture(GLenum format, int width, int height, int levels, GLint filter,
                                    GLint wrap);
/// Our own shaders: one that does not compile is our bug, and the program ends with its message.
[[nodiscard]] GlProgram makeProgram(const char* name, const std::string& vertex,
                                    const std::string& fragment);
/// Where a uniform of the program is; -1 when the compiler found no use for it.
[[nodiscard]] GLint uniform(const GlProgram& program, const char* name);

}  // namespace emulator::studio
