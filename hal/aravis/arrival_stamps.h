#pragma once

#include <array>
#include <cstddef>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace hal::aravis {

/// First-packet instants of the frames that are filling, oldest first.
///
/// Aravis says that a frame has begun without saying which, and delivers frames in the order
/// in which they began: the oldest stamp belongs to the frame delivered next.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free, fixed storage. More frames than fit overwrite the oldest stamps.
class ArrivalStamps {
 public:
  void begin(rt::Timestamp at) RT_SAFE { stamps_[begun_++ % kCapacity] = at; }

  /// The stamp of the frame delivered now; @p otherwise if its begin was not seen.
  [[nodiscard]] rt::Timestamp deliver(rt::Timestamp otherwise) RT_SAFE {
    if (delivered_ == begun_) return otherwise;
    if (begun_ - delivered_ > kCapacity) delivered_ = begun_ - kCapacity;
    return stamps_[delivered_++ % kCapacity];
  }

 private:
  static constexpr std::size_t kCapacity = 64;  // far above any number of slots in flight
  std::array<rt::Timestamp, kCapacity> stamps_{};
  std::size_t begun_ = 0;
  std::size_t delivered_ = 0;
};

}  // namespace hal::aravis
