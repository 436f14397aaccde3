#pragma once

#include <cstdint>
#include <type_traits>

#include "appliance/director/shot.h"
#include "hal/overlay.h"
#include "rt/doorbell.h"
#include "rt/latest_value.h"

namespace appliance {

/// What the overlay is about: the shot that is being shown, on a picture of this size.
struct OverlaySubject {
  Shot shot;
  std::uint32_t cameras = 0;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;

  friend bool operator==(const OverlaySubject&, const OverlaySubject&) = default;
};
static_assert(std::is_trivially_copyable_v<OverlaySubject>, "crosses threads");

/// The render thread publishes here what it shows and gets from here what to draw over it. Neither
/// thread waits for the other: an overlay appears with the next picture (decision 0018).
///
/// Threads  `render` writes the subject and rings; `ui` writes the overlay.
/// Memory   Some 100 kB: three overlays.
struct OverlayBoard {
  rt::LatestValue<OverlaySubject> subject;
  rt::Doorbell subject_changed;
  rt::LatestValue<hal::Overlay> overlay;
};

}  // namespace appliance
