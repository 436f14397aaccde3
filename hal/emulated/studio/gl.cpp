#include "hal/emulated/studio/gl.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace emulator::studio {
namespace {

constexpr const char* kInstall =
    ": install libegl1, libgles2 and libgl1-mesa-dri or a GPU's driver, or take --scene stamp, "
    "which needs neither";

std::unexpected<std::string> lack(const std::string& what) {
  return std::unexpected("the studio is drawn with OpenGL ES 3 on EGL, and " + what + kInstall);
}

GlHandle<deleteProgram> link(const char* name, GLuint vertex, GLuint fragment) {
  GlProgram program(glCreateProgram());
  glAttachShader(program.get(), vertex);
  glAttachShader(program.get(), fragment);
  glLinkProgram(program.get());
  GLint good = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &good);
  if (good == 0) {
    std::array<char, 2048> log{};
    glGetProgramInfoLog(program.get(), log.size(), nullptr, log.data());
    std::fprintf(stderr, "kagami-emulator: shader %s: %s\n", name, log.data());
    std::abort();
  }
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  return program;
}

GLuint compile(const char* name, GLenum kind, const std::string& body) {
  const std::string text =
      "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
      "precision highp sampler2DShadow;\nprecision highp sampler2DArrayShadow;\nprecision highp "
      "sampler2DArray;\n" +
      body;
  const char* source = text.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == 0) {
    std::array<char, 2048> log{};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    std::fprintf(stderr, "kagami-emulator: shader %s: %s\n", name, log.data());
    std::abort();
  }
  return shader;
}

}  // namespace

std::expected<std::unique_ptr<GlContext>, std::string> GlContext::create() {
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  EGLDisplay display = EGL_NO_DISPLAY;
  if (get_display != nullptr) {
    display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  }
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
      return lack("there is no EGL without a window system");
    }
  }
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_ES_API);
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) {
    return lack("EGL offers no OpenGL ES 3");
  }
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (context == EGL_NO_CONTEXT) return lack("no OpenGL ES 3 context can be made");
  std::unique_ptr<GlContext> made(new GlContext(display, context));
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
    return lack("no context can be made current without a surface");
  }
  made->renderer_ = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", " +
                    reinterpret_cast<const char*>(glGetString(GL_VERSION));
  return made;
}

GlContext::~GlContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

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

GlBuffer makeBuffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return GlBuffer(name);
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
GlVertexArray makeVertexArray() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture makeTexture(GLenum format, int width, int height, int levels, GLint filter, GLint wrap) {
  GLuint name = 0;
  glGenTextures(1, &name);
  GlTexture texture(name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, levels, format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER,
                  filter == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  return texture;
}

GlProgram makeProgram(const char* name, const std::string& vertex, const std::string& fragment) {
  return link(name, compile(name, GL_VERTEX_SHADER, vertex),
              compile(name, GL_FRAGMENT_SHADER, fragment));
}

GLint uniform(const GlProgram& program, const char* name) {
  return glGetUniformLocation(program.get(), name);
}

}  // namespace emulator::studio
