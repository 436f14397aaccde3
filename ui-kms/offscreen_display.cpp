#include "ui-kms/offscreen_display.h"

#include <cassert>

namespace ui {
namespace {

rt::Error contextElsewhere() {
  return {rt::Errc::kDeviceLost, 0, "the GL context is bound to another thread"};
}

std::string complaint(const OffscreenConfig& config) {
  constexpr std::uint32_t kMostPx = 8192;
  const auto& [width_px, height_px] =
      std::pair(config.renderer.width_px, config.renderer.height_px);
  if (width_px == 0 || height_px == 0 || width_px > kMostPx || height_px > kMostPx) {
    return "display size " + std::to_string(width_px) + "x" + std::to_string(height_px) +
           " px: give 1 to " + std::to_string(kMostPx) + " each way";
  }
  if (!(config.refresh_hz > 0 && config.refresh_hz <= 1000)) {
    return "display refresh_hz " + std::to_string(config.refresh_hz) + ": give 1 to 1000";
  }
  if (config.buffers < 2 || config.buffers > 8) {
    return "display buffers " + std::to_string(config.buffers) + ": give 2 to 8";
  }
  return {};
}

}  // namespace

std::expected<std::unique_ptr<OffscreenDisplay>, std::string> OffscreenDisplay::create(
    const OffscreenConfig& config) {
  if (const std::string wrong = complaint(config); !wrong.empty()) return std::unexpected(wrong);
  auto renderer = Renderer::create(config.renderer);
  if (!renderer) return std::unexpected(renderer.error());
  std::unique_ptr<OffscreenDisplay> display(new OffscreenDisplay(config, std::move(*renderer)));
  for (std::uint32_t i = 0; i < config.buffers; ++i) {
    auto target = makeRenderTarget(config.renderer.width_px, config.renderer.height_px);
    if (!target) return std::unexpected(target.error());
    display->targets_.push_back(std::move(*target));
  }
  display->detach();
  return display;
}

OffscreenDisplay::OffscreenDisplay(const OffscreenConfig& config,
                                   std::unique_ptr<Renderer> renderer)
    : config_(config),
      renderer_(std::move(renderer)),
      chain_(config.buffers, FlipGrid(rt::now(), config.refresh_hz)),
      pacer_(config.refresh_hz) {}

OffscreenDisplay::~OffscreenDisplay() {
  // Where the render thread still holds the context, the objects end with it instead.
  static_cast<void>(renderer_->context().bind());
}

hal::DisplayMode OffscreenDisplay::mode() const {
  const SizePx upright = Orientation(config_.renderer.rotation_deg)
                             .turned(SizePx{config_.renderer.width_px, config_.renderer.height_px});
  return {upright.width, upright.height, config_.refresh_hz};
}

std::string_view OffscreenDisplay::renderer() const {
  return renderer_->context().renderer();
}

rt::Result<hal::RenderInstants> OffscreenDisplay::render(const hal::Scene& scene) {
  if (!renderer_->context().bind()) return std::unexpected(contextElsewhere());
  const auto buffer = chain_.tryBeginDraw(rt::now());
  if (!buffer) return std::unexpected(buffer.error());
  const hal::RenderInstants instants = renderer_->draw(targets_[*buffer], scene);
  chain_.finishDraw(*buffer);
  pacer_.onPicture(instants);
  return instants;
}

rt::Result<rt::Timestamp> OffscreenDisplay::commit(std::uint64_t picture_id) {
  return chain_.commit(picture_id, rt::now());
}

std::optional<hal::PageFlip> OffscreenDisplay::tryPopFlip() {
  const auto flip = chain_.tryPopFlip(rt::now());
  if (flip) pacer_.onVblank(flip->vblank, flip->page_flip);
  return flip;
}

std::optional<rt::Timestamp> OffscreenDisplay::nextCall() const {
  if (!chain_.drawn() || !chain_.pending()) return std::nullopt;
  return chain_.committedFlip()->page_flip;
}

std::optional<hal::PageFlip> OffscreenDisplay::committedFlip() const {
  return chain_.committedFlip();
}

rt::Result<const RenderTarget*> OffscreenDisplay::committedTarget() {
  if (!renderer_->context().bind()) return std::unexpected(contextElsewhere());
  const auto buffer = chain_.committed();
  if (!buffer || chain_.state(*buffer) == BufferState::kDrawn) {
    return std::unexpected(rt::Error{rt::Errc::kUnsupported, 0, "read: nothing committed"});
  }
  return &targets_[*buffer];
}

rt::Result<void> OffscreenDisplay::readPicture(std::span<std::byte> rgba) {
  const auto target = committedTarget();
  if (!target) return std::unexpected(target.error());
  return renderer_->read(**target, rgba);
}

}  // namespace ui
