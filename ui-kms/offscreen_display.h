#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/display.h"
#include "ui-kms/frame_pacer.h"
#include "ui-kms/picture_source.h"
#include "ui-kms/render_target.h"
#include "ui-kms/renderer.h"
#include "ui-kms/swap_chain.h"

namespace ui {

struct OffscreenConfig {
  RendererConfig renderer;
  double refresh_hz = 60;
  std::uint32_t buffers = 3;
  hal::ScreenStatus screen;  ///< what screen() returns: why this stands in for a screen, if it does
};

/// A screen without a screen: the same drawing, buffers and vblanks, kept in memory.
///
/// Threads  create() on a SCHED_OTHER thread; afterwards one caller, the render thread. It calls
///          detach() before it ends, so that another thread may destroy the display.
/// Errors   create(): one line: which part of EGL or GL is missing, or what is wrong in @p config.
class OffscreenDisplay final : public hal::Display, public PictureSource {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<OffscreenDisplay>, std::string> create(
      const OffscreenConfig& config);
  ~OffscreenDisplay() override;

  [[nodiscard]] hal::DisplayMode mode() const override;
  [[nodiscard]] std::string_view renderer() const override;
  [[nodiscard]] std::string_view uploadReason() const override { return renderer_->uploadReason(); }
  [[nodiscard]] hal::Typesetter* typesetter() override { return renderer_->typesetter(); }
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& scene) override;
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t picture_id) override;
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override;

  [[nodiscard]] rt::Result<void> readPicture(std::span<std::byte> rgba) override;
  [[nodiscard]] std::optional<hal::PageFlip> committedFlip() const override;

  /// Why pictures carry no text; empty where they do.
  [[nodiscard]] const std::string& textWarning() const { return renderer_->textWarning(); }
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override {
    return pacer_.timing();
  }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override;
  [[nodiscard]] hal::ScreenStatus screen() const override { return config_.screen; }
  /// No other program can show anything here.
  void releaseScreen() override {}
  void takeScreen() override {}
  void detach() override { renderer_->context().release(); }

 private:
  OffscreenDisplay(const OffscreenConfig& config, std::unique_ptr<Renderer> renderer);
  [[nodiscard]] rt::Result<const RenderTarget*> committedTarget();

  OffscreenConfig config_;
  std::unique_ptr<Renderer> renderer_;
  SwapChain chain_;
  FramePacer pacer_;
  std::vector<RenderTarget> targets_;
};

}  // namespace ui
