#pragma once

#include <expected>
#include <memory>
#include <optional>
#include <string>

#include "rt/unique_fd.h"

struct gbm_device;

namespace gl {

/// One OpenGL ES 3 context without a window surface: pictures go into framebuffer objects.
///
/// Threads  create() runs on a SCHED_OTHER thread, because the driver's own threads inherit
///          the policy of the thread that makes the context. It leaves the context current
///          there, for making objects; release() ends that. bind() hands it to its caller.
/// Errors   create(): one line that says what is missing and what to install.
class Context {
 public:
  /// @p software_threads: worker threads of a software renderer (0 draws on the caller);
  /// without a value the driver's default. Only the first context of a process decides.
  /// @p gbm: draws on that graphics card, and outlives the context; none: on any.
  [[nodiscard]] static std::expected<std::unique_ptr<Context>, std::string> create(
      std::optional<unsigned> software_threads, gbm_device* gbm = nullptr);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes the context current on the calling thread; cheap where it already is.
  /// False where another thread holds it.
  [[nodiscard]] bool bind();
  /// The calling thread lets go of the context.
  void release();

  /// A fence behind everything drawn so far, for the kernel; none where the driver has no such
  /// thing (EGL_ANDROID_native_fence_sync): glFinish() then.
  [[nodiscard]] rt::UniqueFd tryFence() const;

  /// EGLDisplay.
  [[nodiscard]] void* display() const { return display_; }
  /// GL_RENDERER and GL_VERSION: pictures are the same bit for bit only where both are.
  [[nodiscard]] const std::string& renderer() const { return renderer_; }
  [[nodiscard]] const std::string& version() const { return version_; }
  /// Whether the CPU draws: then every shader instruction is paid in milliseconds.
  [[nodiscard]] bool software() const { return software_; }
  /// Whether imported memory may be drawn from. Mesa's software renderer on a KMS device offers the
  /// import, but cannot map what it imported, and crashes at the first pixel.
  [[nodiscard]] bool readsForeignMemory() const { return surfaceless_ || !software_; }

 private:
  Context(void* display, void* context, bool surfaceless)
      : display_(display), context_(context), surfaceless_(surfaceless) {}

  void* display_;  // EGLDisplay and EGLContext: EGL's header stays out of ours
  void* context_;
  bool surfaceless_;
  std::string renderer_;
  std::string version_;
  bool software_ = false;
  bool fences_ = false;
};

}  // namespace gl
