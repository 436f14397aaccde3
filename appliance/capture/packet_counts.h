#pragma once

#include <cstdint>

#include "hal/camera.h"
#include "rt/counter.h"

namespace appliance {

/// What the wire did to one camera's packets since the box started. A camera counts from its last
/// start and may be opened again and again: this goes on counting.
///
/// Threads  take(): one. The counters: any.
/// RT       Wait-free.
struct PacketCounts {
  rt::Counter resent;     ///< asked for again
  rt::Counter missing;    ///< never came
  rt::Counter underruns;  ///< found no free slot

  /// @p counted: since the camera's last start.
  void take(const hal::CameraStatistics& counted) RT_SAFE {
    resent.add(grown(counted.packets_resent, last_.packets_resent));
    missing.add(grown(counted.packets_missing, last_.packets_missing));
    underruns.add(grown(counted.underruns, last_.underruns));
    last_ = counted;
  }

 private:
  /// Fewer than before: the camera was started again.
  static std::uint64_t grown(std::uint64_t now, std::uint64_t before) {
    return now >= before ? now - before : now;
  }

  hal::CameraStatistics last_;
};

}  // namespace appliance
