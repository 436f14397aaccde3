#include "ui-kms/gl_objects.h"

#include <array>

namespace ui {
namespace {

std::expected<GLuint, std::string> compile(const char* pass, GLenum stage,
                                           const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  glDeleteShader(shader);
  return std::unexpected(std::string(pass) + " shader refused by the GL driver: " + log.data());
}

}  // namespace

void deleteTexture(GLuint name) {
  glDeleteTextures(1, &name);
}
void deleteBuffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
void deleteFramebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
void deleteRenderbuffer(GLuint name) {
  glDeleteRenderbuffers(1, &name);
}
void deleteProgram(GLuint name) {
  glDeleteProgram(name);
}
void deleteVertexArray(GLuint name) {
  glDeleteVertexArrays(1, &name);
}

GlFramebuffer makeFramebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return GlFramebuffer(name);
}

GlRenderbuffer makeRenderbuffer() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return GlRenderbuffer(name);
}

GlBuffer makeBuffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return GlBuffer(name);
}

GlVertexArray makeVertexArray() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture makeTexture(GLenum format, std::uint32_t width_px, std::uint32_t height_px, GLint filter,
                      GLint wrap) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, static_cast<GLsizei>(width_px),
                 static_cast<GLsizei>(height_px));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  return GlTexture(name);
}

RenderTarget makeRenderTarget(std::uint32_t width_px, std::uint32_t height_px) {
  RenderTarget target;
  target.width_px = width_px;
  target.height_px = height_px;
  target.colour = makeTexture(GL_RGBA8, width_px, height_px, GL_LINEAR, GL_CLAMP_TO_EDGE);
  target.framebuffer = makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.colour.get(),
                         0);
  return target;
}

rt::Result<void> readTarget(const RenderTarget& target, std::span<std::byte> rgba) {
  if (rgba.size() != std::size_t{4} * target.width_px * target.height_px) {
    return std::unexpected(rt::Error{rt::Errc::kInvalidConfig, 0, "read: size of the buffer"});
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px),
               GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return {};
}

std::expected<GlProgram, std::string> makeProgram(const char* pass, const std::string& vertex,
                                                  const std::string& fragment) {
  const auto vertex_shader = compile(pass, GL_VERTEX_SHADER, vertex);
  if (!vertex_shader) return std::unexpected(vertex_shader.error());
  const auto fragment_shader = compile(pass, GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader) {
    glDeleteShader(*vertex_shader);
    return std::unexpected(fragment_shader.error());
  }
  GlProgram program(glCreateProgram());
  for (const GLuint shader : {*vertex_shader, *fragment_shader}) {
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);  // lives on as long as it is attached
  }
  glLinkProgram(program.get());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program.get(), log.size(), nullptr, log.data());
  return std::unexpected(std::string(pass) + " program refused by the GL driver: " + log.data());
}

}  // namespace ui
