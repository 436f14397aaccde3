#pragma once

#include "appliance/trace/records.h"
#include "hal/display.h"

namespace appliance {

/// One picture that was just handed to the display.
struct ShownPicture {
  const PictureRecord& record;
  const hal::Scene& scene;
};

/// Receives every picture that was shown; the recorder is one.
class PictureObserver {
 public:
  virtual ~PictureObserver() = default;
  /// On the render thread, after the commit: its time is the next picture's.
  virtual void onPicture(const ShownPicture& picture) noexcept = 0;
};

}  // namespace appliance
