#include "hal/gl/context.h"

#include <cstdlib>
#include <cstring>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

namespace gl {
namespace {

constexpr const char* kInstall = "install libegl1, libgles2 and libgl1-mesa-dri, or a GPU's driver";

/// Initialized. A handle without a card is the process's only one for its platform, so no context
/// ever terminates it.
EGLDisplay openDisplay(gbm_device* gbm) {
  const auto initialized = [](EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE
               ? display
               : EGL_NO_DISPLAY;
  };
  const auto get_platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_platform_display == nullptr) return EGL_NO_DISPLAY;
  if (gbm != nullptr) return initialized(get_platform_display(EGL_PLATFORM_GBM_KHR, gbm, nullptr));
  EGLDisplay display = initialized(
      get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  // Drivers other than Mesa's draw without a surface on their usual display.
  return display != EGL_NO_DISPLAY ? display : initialized(eglGetDisplay(EGL_DEFAULT_DISPLAY));
}

}  // namespace

std::expected<std::unique_ptr<Context>, std::string> Context::create(
    std::optional<unsigned> software_threads, gbm_device* gbm) {
  if (software_threads) {
    // An operator's own setting of the driver's variable goes first.
    ::setenv("LP_NUM_THREADS", std::to_string(*software_threads).c_str(), /*replace=*/0);
  }
  EGLDisplay display = openDisplay(gbm);
  if (display == EGL_NO_DISPLAY) {
    return std::unexpected(std::string("no EGL without a window system: ") + kInstall);
  }
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_ES_API);
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) {
    return std::unexpected(std::string("EGL offers no OpenGL ES 3: ") + kInstall);
  }
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (context == EGL_NO_CONTEXT) {
    return std::unexpected(std::string("no OpenGL ES 3 context: ") + kInstall);
  }
  std::unique_ptr<Context> made(new Context(display, context, gbm == nullptr));
  if (!made->bind()) {
    return std::unexpected(std::string("EGL cannot make a context current without a surface: ") +
                           kInstall);
  }
  made->renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  made->version_ = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  made->software_ = made->renderer_.find("llvmpipe") != std::string::npos ||
                    made->renderer_.find("softpipe") != std::string::npos;
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  made->fences_ =
      extensions != nullptr && std::strstr(extensions, "EGL_ANDROID_native_fence_sync") != nullptr;
  return made;
}

Context::~Context() {
  release();
  eglDestroyContext(display_, context_);
  if (!surfaceless_) eglTerminate(display_);  // it ends before its card
}

bool Context::bind() {
  if (eglGetCurrentContext() == context_) return true;
  eglBindAPI(EGL_OPENGL_ES_API);  // the choice of API is per thread
  return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

rt::UniqueFd Context::tryFence() const {
  if (!fences_) return {};
  const auto create =
      reinterpret_cast<PFNEGLCREATESYNCKHRPROC>(eglGetProcAddress("eglCreateSyncKHR"));
  const auto destroy =
      reinterpret_cast<PFNEGLDESTROYSYNCKHRPROC>(eglGetProcAddress("eglDestroySyncKHR"));
  const auto duplicate = reinterpret_cast<PFNEGLDUPNATIVEFENCEFDANDROIDPROC>(
      eglGetProcAddress("eglDupNativeFenceFDANDROID"));
  if (create == nullptr || destroy == nullptr || duplicate == nullptr) return {};
  EGLSyncKHR sync = create(display_, EGL_SYNC_NATIVE_FENCE_ANDROID, nullptr);
  if (sync == EGL_NO_SYNC_KHR) return {};
  glFlush();  // only then has the fence a descriptor
  rt::UniqueFd fence(duplicate(display_, sync));
  destroy(display_, sync);
  return fence;
}

void Context::release() {
  if (eglGetCurrentContext() != context_) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace gl
