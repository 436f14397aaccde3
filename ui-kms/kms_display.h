#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/display.h"
#include "rt/unique_fd.h"
#include "ui-kms/frame_pacer.h"
#include "ui-kms/kms/screen.h"
#include "ui-kms/picture_source.h"
#include "ui-kms/renderer.h"
#include "ui-kms/scanout_buffers.h"
#include "ui-kms/scanout_queue.h"

namespace ui {

struct KmsConfig {
  RendererConfig renderer;  ///< its size is used while no screen is connected
  double refresh_hz = 60;   ///< used while no screen is connected
  std::string device;       ///< /dev/dri/cardN; empty: the first with a screen
  std::string mode;         ///< "1920x1080@59.94"; empty: the best for the trigger rate
  double trigger_hz = 0;
  std::uint32_t queue_depth = 1;    ///< 1 or 2: see ScanoutQueue
  std::optional<ScanoutPath> path;  ///< none: direct where the driver can
};

/// A true screen, by atomic mode setting: no desktop, no window system. docs/display.md.
///
/// A screen that is unplugged, replaced or used by another program is an interruption: until
/// it is back render() and commit() return kDeviceLost immediately. mode() may be another
/// afterwards.
///
/// Threads  create() on a SCHED_OTHER thread; afterwards one caller, the render thread. It calls
///          detach() before it ends, so that another thread may destroy the display.
/// Memory   Everything is made by create(), and again when a screen has another size.
/// Errors   create(): one line: no card, no permission, no atomic mode setting, no EGL, or what is
///          wrong in @p config. A missing screen is no error.
class KmsDisplay final : public hal::Display, public PictureSource {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<KmsDisplay>, std::string> create(
      const KmsConfig& config);
  ~KmsDisplay() override;

  [[nodiscard]] hal::DisplayMode mode() const override;
  [[nodiscard]] std::string_view renderer() const override;
  [[nodiscard]] std::string_view uploadReason() const override { return renderer_->uploadReason(); }
  [[nodiscard]] hal::Typesetter* typesetter() override { return renderer_->typesetter(); }
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& scene) override;
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t picture_id) override;
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override;
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override;
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override;
  [[nodiscard]] hal::ScreenStatus screen() const override;
  void releaseScreen() override;
  void takeScreen() override;
  void detach() override { renderer_->context().release(); }

  [[nodiscard]] rt::Result<void> readPicture(std::span<std::byte> rgba) override;
  [[nodiscard]] std::optional<hal::PageFlip> committedFlip() const override;

  /// Why pictures carry no text; empty where they do.
  [[nodiscard]] const std::string& textWarning() const { return renderer_->textWarning(); }
  /// For the log: connector, mode, card, and how pictures get to the screen.
  [[nodiscard]] std::string description() const;
  [[nodiscard]] ScanoutPath path() const { return path_; }

 private:
  struct CloseGbm {
    void operator()(gbm_device* gbm) const;
  };
  /// The picture in a buffer, until it flips.
  struct Drawing {
    hal::RenderInstants instants;
    rt::Timestamp submit;  // to the kernel
    rt::UniqueFd fence;    // none: all pixels are written
  };

  KmsDisplay(const KmsConfig& config, std::unique_ptr<kms::Screen> screen);
  [[nodiscard]] std::expected<void, std::string> makeRenderer();
  [[nodiscard]] std::expected<void, std::string> makeBuffers();
  void attend(rt::Timestamp now);
  void onFlip(const kms::FlipEvent& event, rt::Timestamp now);
  void followMode();
  [[nodiscard]] bool buffersFit() const;
  [[nodiscard]] rt::Result<void> fitBuffers(rt::Timestamp now);
  [[nodiscard]] rt::Result<void> submit(std::uint32_t buffer, std::uint64_t picture_id,
                                        rt::Timestamp now);

  const KmsConfig config_;
  std::unique_ptr<kms::Screen> screen_;  // has the card's descriptor: outlives what follows
  std::unique_ptr<gbm_device, CloseGbm> gbm_;
  std::unique_ptr<Renderer> renderer_;
  ScanoutPath path_ = ScanoutPath::kDirect;
  std::optional<ScanoutBuffers> buffers_;  // none after a size that had no room
  std::string no_buffers_;                 // why, and what to do
  rt::Nanoseconds fit_pause_{};            // until the next try
  rt::Timestamp next_fit_;
  ScanoutQueue queue_;
  std::vector<Drawing> drawings_;  // per buffer
  FramePacer pacer_;

  hal::DisplayMode mode_;      // the screen's own, whatever way it hangs
  std::uint64_t changes_ = 0;  // of the screen, as far as followed
  std::uint64_t losses_ = 0;
  std::uint64_t serial_ = 0;           // of the last commit
  std::optional<bool> vblanks_known_;  // asked at the first flip of a mode
  kms::Vblank vblank_{};               // of the last flip
  std::vector<kms::FlipEvent> events_;
};

}  // namespace ui
