#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/display_timing.h"
#include "hal/scene.h"
#include "hal/screen_status.h"
#include "hal/typesetter.h"
#include "rt/clock.h"
#include "rt/result.h"

namespace hal {

struct DisplayMode {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  double refresh_hz = 0;
};

/// When one picture passed the stages of the renderer.
struct RenderInstants {
  rt::Timestamp warp_submit;  ///< drawing starts: demosaic and upload come next
  rt::Timestamp upload_end;   ///< demosaiced and uploaded
  rt::Timestamp warp_end;     ///< all pixels written, or left to a GPU whose fence the screen heeds
  bool imported = false;      ///< the frame was read in its slot, not uploaded
};

struct PageFlip {
  std::uint64_t picture_id;
  rt::Timestamp page_flip;  ///< the vblank at which the picture came on screen
  std::uint64_t vblank;     ///< that vblank's number
};

/// A screen that shows one picture at a time.
///
/// Threads  One caller: the render thread. The object is made (EGL context included) on a
///          SCHED_OTHER thread and handed over: the first call binds the context to its caller.
/// RT       Nothing here is RT safe: GL and commits may block.
/// Errors   kBusy: the last commit has not flipped yet. kDeviceLost: there is no screen, or it is
///          released; pictures go on when it is back. Both leave the object usable.
class Display {
 public:
  virtual ~Display() = default;

  /// The size of the upright picture that render() draws; between calls it may change with the
  /// screen.
  [[nodiscard]] virtual DisplayMode mode() const = 0;
  /// What draws, for the report: GL_RENDERER.
  [[nodiscard]] virtual std::string_view renderer() const = 0;
  /// Why frames are uploaded even if they come as dma-bufs, in one line; empty if those are read in
  /// place.
  [[nodiscard]] virtual std::string_view uploadReason() const = 0;

  /// Makes the letters of overlays for this display. Another thread than the render thread may call
  /// it. It lives as long as the display. None if there is no font: pictures carry no text.
  [[nodiscard]] virtual Typesetter* typesetter() = 0;

  /// Draws into a free buffer, done when it returns.
  [[nodiscard]] virtual rt::Result<RenderInstants> render(const Scene& scene) = 0;

  /// Hands the buffer just drawn to the next vblank; the instant it did.
  [[nodiscard]] virtual rt::Result<rt::Timestamp> commit(std::uint64_t picture_id) = 0;

  /// Page flips since the last call, oldest first.
  [[nodiscard]] virtual std::optional<PageFlip> tryPopFlip() = 0;

  /// None while vblanks are not known: no screen, or too few flips so far.
  [[nodiscard]] virtual std::optional<DisplayTiming> timing() const = 0;

  /// Call the display by then even without a new picture, so that a queued or refused one is
  /// submitted in time. None: no deadline.
  [[nodiscard]] virtual std::optional<rt::Timestamp> nextCall() const = 0;

  [[nodiscard]] virtual ScreenStatus screen() const = 0;

  /// Lets go of the screen so that another program can show something, and takes it again.
  virtual void releaseScreen() = 0;
  virtual void takeScreen() = 0;

  /// The caller's last call before another thread calls or destroys the display.
  virtual void detach() = 0;
};

}  // namespace hal
