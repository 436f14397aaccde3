#pragma once

#include <cstdint>

#include "rt/annotations.h"

namespace hal::aravis {

/// Unwraps GigE Vision's 16 bit block id. By the standard it runs 1..65535 and skips 0; some
/// cameras do not skip it.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free.
class FrameIdUnwrapper {
 public:
  /// The count of a whole frame. They come in order, at most kFurthest frames apart; a 64 bit id
  /// (GigE Vision 2) passes as it is.
  [[nodiscard]] std::uint64_t unwrap(std::uint64_t id) RT_SAFE {
    if (id > kLast) return id;
    if (id == 0) ids_ = kLast + 1;  // this camera does not skip it
    unwrapped_ += stepTo(id);
    started_ = true;
    last_ = id;
    return unwrapped_;
  }

  /// The count of a frame with packets missing. If its leader is missing, too, Aravis gives the id
  /// of the frame that had the buffer before: then the count is 0, which means unknown. The next
  /// whole frame is counted from the last whole one, whatever this id is.
  [[nodiscard]] std::uint64_t ofDamaged(std::uint64_t id) const RT_SAFE {
    if (id > kLast) return id;
    const std::uint64_t step = stepTo(id);
    return step <= kFurthest ? unwrapped_ + step : 0;
  }

 private:
  static constexpr std::uint64_t kLast = 65535;
  static constexpr std::uint64_t kFurthest = 32767;

  [[nodiscard]] std::uint64_t stepTo(std::uint64_t id) const RT_SAFE {
    return started_ ? (id + ids_ - last_) % ids_ : id;
  }

  bool started_ = false;
  std::uint64_t ids_ = kLast;  // how many there are
  std::uint64_t last_ = 0;
  std::uint64_t unwrapped_ = 0;
};

}  // namespace hal::aravis
