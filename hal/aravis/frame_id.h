#pragma once

#include <cstdint>

#include "rt/annotations.h"

namespace hal::aravis {

/// Unwraps GigE Vision's 16 bit block id, which runs 1..65535 and skips 0.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free.
class FrameIdUnwrapper {
 public:
  /// Ids come in order, at most 32767 frames apart; a 64 bit id (GigE Vision 2) passes as it is.
  [[nodiscard]] std::uint64_t unwrap(std::uint64_t id) RT_SAFE {
    if (id > kLast) return id;
    const std::uint64_t step = started_ ? (id + kLast - last_) % kLast : id;
    started_ = true;
    last_ = id;
    return unwrapped_ += step;
  }

 private:
  static constexpr std::uint64_t kLast = 65535;
  bool started_ = false;
  std::uint64_t last_ = 0;
  std::uint64_t unwrapped_ = 0;
};

}  // namespace hal::aravis
