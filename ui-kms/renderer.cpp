#include "ui-kms/renderer.h"

#include <cassert>
#include <cstring>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "rt/clock.h"

namespace ui {

std::expected<std::unique_ptr<Renderer>, std::string> Renderer::create(
    const RendererConfig& config) {
  auto context = gl::Context::create(config.software_threads, config.gbm);
  if (!context) return std::unexpected(context.error());
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(*context)));
  DemosaicSite site = config.demosaic;
  if (site == DemosaicSite::kAuto) {
    site = renderer->context_->software() ? DemosaicSite::kCpu : DemosaicSite::kGpu;
  }
  // OpenCV's helpers have no real-time priority; the render thread must not wait for them.
  if (site == DemosaicSite::kCpu) cv::setNumThreads(1);
  auto source = SourceTexture::create(site);
  if (!source) return std::unexpected(source.error());
  renderer->source_ = std::move(*source);
  renderer->source_->tryImport(*renderer->context_, config.source_width_px,
                               config.source_height_px);
  renderer->font_path_ = config.font_path;
  if (auto sized = renderer->resize(config.width_px, config.height_px); !sized) {
    return std::unexpected(sized.error());
  }
  renderer->warmUp(config);
  return renderer;
}

std::expected<void, std::string> Renderer::resize(std::uint32_t width_px, std::uint32_t height_px) {
  auto warp = WarpPass::create(width_px, height_px);
  if (!warp) return std::unexpected(warp.error());
  warp_ = std::move(*warp);
  auto status = StatusLinePass::create(font_path_, width_px, height_px);
  status_.reset();
  text_warning_.clear();
  if (status) {
    status_ = std::move(*status);
  } else {
    text_warning_ = status.error() + "; pictures go on without text";
  }
  return {};
}

/// Drivers compile at the first draw. That belongs here, on the thread that may take its time
/// (and whose scheduling policy the driver's threads inherit), not into the first picture.
void Renderer::warmUp(const RendererConfig& config) {
  const std::uint32_t width_px = config.source_width_px != 0 ? config.source_width_px : 64;
  const std::uint32_t height_px = config.source_height_px != 0 ? config.source_height_px : 64;
  const std::vector<std::byte> black(std::size_t{width_px} * height_px);
  hal::Scene scene{.count = 1};
  hal::WarpPlan& plan = scene.layers[0].plan;
  plan.source = {black.data(), width_px, height_px, hal::PixelFormat::kBayerRG8};
  plan.H_camera_display = {1, 0, -16, 0, 1, -16, 0, 0, 1};  // inner and edge cells both
  plan.lens = {.fx_px = 1, .fy_px = 1, .max_radius = 1e9};
  std::strncpy(scene.status.text.data(), "kagami", scene.status.text.size() - 1);
  const RenderTarget target = makeRenderTarget(config.width_px, config.height_px);
  draw(target, scene);
}

hal::RenderInstants Renderer::draw(const RenderTarget& target, const hal::Scene& scene,
                                   rt::UniqueFd* fence) {
  hal::RenderInstants instants;
  instants.warp_submit = rt::now();
  const hal::WarpPlan& plan = scene.layers[0].plan;
  const bool drawable = scene.count != 0 && plan.source.pixels != nullptr;
  const auto source = drawable ? source_->load(plan.source) : SourceTexture::Loaded{};
  instants.imported = source.imported;
  instants.upload_end = rt::now();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
  glViewport(0, 0, static_cast<GLsizei>(target.width_px), static_cast<GLsizei>(target.height_px));
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (drawable) warp_->draw(plan, source.colour);
  if (status_) status_->draw(scene.status);
  if (fence != nullptr) *fence = context_->tryFence();
  if (fence == nullptr || !fence->valid()) glFinish();
  instants.warp_end = rt::now();
  return instants;
}

}  // namespace ui
