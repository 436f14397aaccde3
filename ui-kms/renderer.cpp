#include "ui-kms/renderer.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "rt/clock.h"
#include "ui-kms/warp_shaders.h"

namespace ui {
namespace {

hal::RectPx partOf(SizePx picture, const hal::RectPx& where) {
  return common(where, {0, 0, static_cast<std::int32_t>(picture.width),
                        static_cast<std::int32_t>(picture.height)});
}

/// All of @p target from here on.
void drawInto(const RenderTarget& target) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glViewport(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px));
}

}  // namespace

std::expected<std::unique_ptr<Renderer>, std::string> Renderer::create(
    const RendererConfig& config) {
  auto context = gl::Context::create(config.software_threads, config.gbm);
  if (!context) return std::unexpected(context.error());
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(*context), config));
  auto made = renderer->makePasses(config);
  if (made) made = renderer->resize(config.width_px, config.height_px);
  if (made) made = renderer->warmUp(config);
  if (!made) return std::unexpected(made.error());
  return renderer;
}

std::expected<void, std::string> Renderer::makePasses(const RendererConfig& config) {
  DemosaicSite site = config.demosaic;
  if (site == DemosaicSite::kAuto) {
    site = context_->software() ? DemosaicSite::kCpu : DemosaicSite::kGpu;
  }
  // OpenCV's helpers have no real-time priority; the render thread must not wait for them.
  if (site == DemosaicSite::kCpu) cv::setNumThreads(1);
  auto source = SourceCache::create(site);
  if (!source) return std::unexpected(source.error());
  source_ = std::move(*source);
  source_->tryImport(*context_, config.sources);
  for (const SizePx size : config.sources) {
    if (auto made = source_->prepare(size); !made) return made;
  }
  auto warp = WarpPass::create();
  if (!warp) return std::unexpected(warp.error());
  warp_ = std::move(*warp);
  auto blend = BlendTarget::create();
  if (!blend) return std::unexpected(blend.error());
  blend_ = std::move(*blend);
  auto overlay = OverlayPass::create(*glyphs_);
  if (!overlay) return std::unexpected(overlay.error());
  overlay_ = std::move(*overlay);
  if (auto fonts = FontSet::create(config.font_path)) {
    typesetter_ = std::make_unique<TextSetter>(std::move(*fonts), *glyphs_);
  } else {
    text_warning_ = fonts.error() + "; pictures go on without text";
  }
  return {};
}

std::expected<void, std::string> Renderer::resize(std::uint32_t width_px, std::uint32_t height_px) {
  const SizePx picture = orientation_.turned(SizePx{width_px, height_px});
  auto sized = warp_->resize(picture, orientation_);
  if (sized) sized = blend_->resize(width_px, height_px, blending_);
  if (!sized) return sized;
  overlay_->resize(picture, orientation_);
  picture_ = picture;
  if (!orientation_.upright()) scratch_.resize(std::size_t{4} * width_px * height_px);
  return {};
}

rt::Result<void> Renderer::read(const RenderTarget& target, std::span<std::byte> rgba) {
  return readTarget(target, orientation_, scratch_, rgba);
}

/// Drivers compile at the first draw. That belongs here, on the thread that may take its time
/// (and whose scheduling policy the driver's threads inherit), not into the first picture. A grey
/// frame that comes out as another grey shows what no call has reported.
std::expected<void, std::string> Renderer::warmUp(const RendererConfig& config) {
  const SizePx size = config.sources.empty() ? SizePx{64, 64} : config.sources.front();
  const std::vector<std::byte> grey(std::size_t{size.width} * size.height, std::byte{128});
  hal::Scene scene{.count = 1};
  hal::WarpPlan& plan = scene.layers[0].plan;
  plan.source = {grey.data(), size.width, size.height, hal::PixelFormat::kBayerRG8};
  plan.H_camera_display = {1, 0, -16, 0, 1, -16, 0, 0, 1};  // inner and edge cells both
  plan.lens = {.fx_px = 1, .fy_px = 1, .max_radius = 1e9};
  const auto overlay = std::make_unique<hal::Overlay>();
  overlay->add({.width_px = 8, .height_px = 8});
  overlay->add({.kind = hal::OverlayItem::Kind::kGlyph, .width_px = 1, .height_px = 1});
  overlay->generation = 1;
  scene.overlay = overlay.get();
  const auto target = makeRenderTarget(config.width_px, config.height_px);
  if (!target) return std::unexpected(target.error());
  draw(*target, scene);
  if (auto right = expectGrey(*target); !right) return right;
  scene.layers[1] = scene.layers[0];
  scene.layers[0].plan.colour.black_level = 1;  // the whole colour model
  draw(*target, scene);
  scene.layers[1].opacity = 0.5F;
  scene.count = 2;
  *overlay = {};  // the first that is made is another one
  draw(*target, scene);
  return expectGrey(*target);
}

std::expected<void, std::string> Renderer::expectGrey(const RenderTarget& target) const {
  constexpr int kGreySrgb = 188;  // of 128 in linear light
  const hal::RectPx at = orientation_.turned(hal::RectPx{20, 20, 1, 1}, picture_);
  std::array<GLubyte, 4> pixel{};
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.get());
  glReadPixels(at.x, at.y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  const bool grey = std::ranges::all_of(std::span(pixel).first<3>(),
                                        [](int value) { return std::abs(value - kGreySrgb) <= 6; });
  if (grey) return {};
  return std::unexpected("the graphics driver (" + context_->renderer() + ") draws " +
                         std::to_string(pixel[0]) + ", " + std::to_string(pixel[1]) + ", " +
                         std::to_string(pixel[2]) + " for a grey of " + std::to_string(kGreySrgb) +
                         ": install another one");
}

hal::RenderInstants Renderer::draw(const RenderTarget& target, const hal::Scene& scene,
                                   rt::UniqueFd* fence) {
  hal::RenderInstants instants;
  instants.warp_submit = rt::now();
  const Sources sources = load(scene, instants);
  instants.upload_end = rt::now();
  if (needsBlending(scene, sources)) {
    drawInto(blend_->target());
    drawLayers(scene, sources, WarpPass::Output::kLinear);
    drawInto(target);
    blend_->show();
  } else {
    drawInto(target);
    drawLayers(scene, sources, WarpPass::Output::kScreen);
  }
  if (scene.overlay != nullptr) overlay_->draw(*scene.overlay);
  if (fence != nullptr) *fence = context_->tryFence();
  if (fence == nullptr || !fence->valid()) glFinish();
  instants.warp_end = rt::now();
  return instants;
}

/// Demosaiced and uploaded when it returns: the frames' slots may be written again.
Renderer::Sources Renderer::load(const hal::Scene& scene, hal::RenderInstants& instants) {
  Sources sources{};
  instants.imported = scene.count != 0;
  for (std::uint32_t i = 0; i < scene.count; ++i) {
    const hal::ViewLayer& layer = scene.layers[i];
    if (layer.plan.source.pixels == nullptr || !(layer.opacity > 0)) continue;
    if (partOf(picture_, layer.where).empty()) continue;
    const auto loaded = source_->load(layer.plan.source, layer.content);
    sources[i] = loaded.colour;
    instants.imported = instants.imported && loaded.imported;
  }
  source_->finish();
  return sources;
}

bool Renderer::needsBlending(const hal::Scene& scene, const Sources& sources) const {
  for (std::uint32_t i = 0; i < scene.count; ++i) {
    if (sources[i] == 0) continue;
    if (scene.layers[i].opacity < 1) return true;
    for (std::uint32_t below = 0; below < i; ++below) {
      if (sources[below] == 0) continue;
      const auto both = common(scene.layers[i].where, scene.layers[below].where);
      if (!partOf(picture_, both).empty()) return true;
    }
  }
  return false;
}

/// Into the framebuffer that is bound. A picture without layers is black.
void Renderer::drawLayers(const hal::Scene& scene, const Sources& sources,
                          WarpPass::Output output) {
  float beside =
      output == WarpPass::Output::kScreen ? shader::kSurroundCode : shader::kSurroundLight;
  if (scene.count == 0) beside = 0;
  glClearColor(beside, beside, beside, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (output == WarpPass::Output::kLinear) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  for (std::uint32_t i = 0; i < scene.count; ++i) {
    if (sources[i] == 0) continue;
    const hal::ViewLayer& layer = scene.layers[i];
    const auto part = partOf(picture_, layer.where);
    const bool whole = part == partOf(picture_, hal::kWholePicture);
    if (!whole) {
      const auto drawn = orientation_.turned(part, picture_);
      glEnable(GL_SCISSOR_TEST);
      glScissor(drawn.x, drawn.y, drawn.width, drawn.height);
    }
    warp_->draw(i, layer, sources[i], output);
    if (!whole) glDisable(GL_SCISSOR_TEST);
  }
  glDisable(GL_BLEND);
}

}  // namespace ui
