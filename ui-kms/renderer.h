#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>

#include "hal/display.h"
#include "hal/gl/context.h"
#include "ui-kms/render_target.h"
#include "ui-kms/source_texture.h"
#include "ui-kms/status_line_pass.h"
#include "ui-kms/warp_pass.h"

namespace ui {

struct RendererConfig {
  std::uint32_t width_px = 1280;
  std::uint32_t height_px = 720;
  /// Of the cameras, so that their storage exists before the first picture.
  std::uint32_t source_width_px = 0;
  std::uint32_t source_height_px = 0;
  std::string font_path;                     ///< empty: the usual places of DejaVu Sans
  std::optional<unsigned> software_threads;  ///< of a software renderer; none: its default
  gbm_device* gbm = nullptr;                 ///< the graphics card; none: any
  DemosaicSite demosaic = DemosaicSite::kAuto;
};

/// From a scene to a finished picture in a render target; what every display of this folder draws
/// with.
///
/// Threads  create() on a SCHED_OTHER thread; then one caller, which binds the context. With the
///          demosaicing on the CPU it ends OpenCV's own threading in this process.
class Renderer {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<Renderer>, std::string> create(
      const RendererConfig& config);

  [[nodiscard]] gl::Context& context() { return *context_; }
  [[nodiscard]] const gl::Context& context() const { return *context_; }
  /// Why frames are uploaded even where they come as dma-bufs; empty where those are read in place.
  [[nodiscard]] const std::string& uploadReason() const { return source_->uploadReason(); }
  /// Why there is no status line; empty where there is one.
  [[nodiscard]] const std::string& textWarning() const { return text_warning_; }

  /// Another size of pictures from now on. Compiles shaders: tens of milliseconds.
  /// Errors: one line; the size is as before.
  [[nodiscard]] std::expected<void, std::string> resize(std::uint32_t width_px,
                                                        std::uint32_t height_px);

  /// Draws all of @p target; the pixels are written when it returns. With @p fence, and a driver
  /// that has fences, they are written when that one signals; without, it stays empty.
  hal::RenderInstants draw(const RenderTarget& target, const hal::Scene& scene,
                           rt::UniqueFd* fence = nullptr);

 private:
  explicit Renderer(std::unique_ptr<gl::Context> context) : context_(std::move(context)) {}
  void warmUp(const RendererConfig& config);

  std::string font_path_;

  std::unique_ptr<gl::Context> context_;  // first, so that it outlives all GL objects
  std::optional<SourceTexture> source_;
  std::optional<WarpPass> warp_;
  std::optional<StatusLinePass> status_;
  std::string text_warning_;
};

}  // namespace ui
