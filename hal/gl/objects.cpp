#include "hal/gl/objects.h"

#include <array>

namespace gl {
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

Framebuffer makeFramebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return Framebuffer(name);
}

Renderbuffer makeRenderbuffer() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return Renderbuffer(name);
}

Buffer makeBuffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return Buffer(name);
}

VertexArray makeVertexArray() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return VertexArray(name);
}

Texture makeTexture(GLenum format, GLsizei width_px, GLsizei height_px, GLint filter, GLint wrap,
                    int levels) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, levels, format, width_px, height_px);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER,
                  filter == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  return Texture(name);
}

std::expected<Program, std::string> makeProgram(const char* pass, const std::string& vertex,
                                                const std::string& fragment) {
  const auto vertex_shader = compile(pass, GL_VERTEX_SHADER, vertex);
  if (!vertex_shader) return std::unexpected(vertex_shader.error());
  const auto fragment_shader = compile(pass, GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader) {
    glDeleteShader(*vertex_shader);
    return std::unexpected(fragment_shader.error());
  }
  Program program(glCreateProgram());
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

GLint uniform(const Program& program, const char* name) {
  return glGetUniformLocation(program.get(), name);
}

}  // namespace gl
