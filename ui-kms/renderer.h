#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/display.h"
#include "hal/gl/context.h"
#include "ui-kms/blend_target.h"
#include "ui-kms/glyph_store.h"
#include "ui-kms/orientation.h"
#include "ui-kms/overlay_pass.h"
#include "ui-kms/render_target.h"
#include "ui-kms/source_cache.h"
#include "ui-kms/text_setter.h"
#include "ui-kms/warp_pass.h"

namespace ui {

struct RendererConfig {
  std::uint32_t width_px = 1280;
  std::uint32_t height_px = 720;
  std::uint32_t rotation_deg = 0;  ///< how far the screen is turned, as in Orientation
  /// All distinct ones of the cameras, so that their storage exists before the first picture.
  std::vector<SizePx> sources;
  std::string font_path;                     ///< empty: the usual places of DejaVu Sans
  std::optional<unsigned> software_threads;  ///< of a software renderer; none: its default
  gbm_device* gbm = nullptr;                 ///< the graphics card; none: any
  DemosaicSite demosaic = DemosaicSite::kAuto;
  BlendTarget::Storage blending = BlendTarget::Storage::kHalfFloat;  ///< where the driver can
};

/// From a scene to a finished picture in a render target; what every display of this folder draws
/// with.
///
/// One layer, and layers that lie side by side, are drawn straight into the target. Where one shows
/// through another, or hides a part of it, all of them are blended in linear light first.
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
  /// For the thread that makes overlays; none without a font.
  [[nodiscard]] hal::Typesetter* typesetter() { return typesetter_.get(); }
  /// Why there is no text; empty where there is.
  [[nodiscard]] const std::string& textWarning() const { return text_warning_; }

  /// Another size of the screen from now on.
  /// Errors: one line; the size is as before.
  [[nodiscard]] std::expected<void, std::string> resize(std::uint32_t width_px,
                                                        std::uint32_t height_px);

  /// Draws all of @p target; the pixels are written when it returns. With @p fence, and a driver
  /// that has fences, they are written when that one signals; without, it stays empty.
  hal::RenderInstants draw(const RenderTarget& target, const hal::Scene& scene,
                           rt::UniqueFd* fence = nullptr);
  /// As ui::readTarget().
  [[nodiscard]] rt::Result<void> read(const RenderTarget& target, std::span<std::byte> rgba);

 private:
  using Sources = std::array<GLuint, hal::Scene::kMostLayers>;  // 0: that layer is not drawn

  Renderer(std::unique_ptr<gl::Context> context, const RendererConfig& config)
      : blending_(config.blending),
        orientation_(config.rotation_deg),
        context_(std::move(context)),
        glyphs_(std::make_unique<GlyphStore>()) {}
  [[nodiscard]] std::expected<void, std::string> makePasses(const RendererConfig& config);
  [[nodiscard]] std::expected<void, std::string> warmUp(const RendererConfig& config);
  [[nodiscard]] std::expected<void, std::string> expectGrey(const RenderTarget& target) const;
  [[nodiscard]] Sources load(const hal::Scene& scene, hal::RenderInstants& instants);
  [[nodiscard]] bool needsBlending(const hal::Scene& scene, const Sources& sources) const;
  void drawLayers(const hal::Scene& scene, const Sources& sources, WarpPass::Output output);

  BlendTarget::Storage blending_ = BlendTarget::Storage::kHalfFloat;
  Orientation orientation_;
  SizePx picture_;                  // upright
  std::vector<std::byte> scratch_;  // of a turned screen, for reading back

  std::unique_ptr<gl::Context> context_;  // first, so that it outlives all GL objects
  std::optional<SourceCache> source_;
  std::optional<WarpPass> warp_;
  std::optional<BlendTarget> blend_;
  std::unique_ptr<GlyphStore> glyphs_;
  std::unique_ptr<TextSetter> typesetter_;
  std::optional<OverlayPass> overlay_;
  std::string text_warning_;
};

}  // namespace ui
