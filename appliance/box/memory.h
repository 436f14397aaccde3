#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>

#include "appliance/box/remarks.h"
#include "appliance/capture/frame_history.h"
#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"

namespace appliance {

/// What the history is made for.
struct HistoryUse {
  std::uint32_t pins_per_camera = 0;  ///< of all readers together
  /// In memory that a GPU can read in place. The price: most of its pages are small.
  bool shared = false;
};

/// The frame history as configured, or as large as this machine's memory allows.
/// Errors  One line: there is too little memory.
[[nodiscard]] std::expected<std::unique_ptr<FrameHistory>, std::string> makeHistory(
    const Config& config, const Rig& rig, const HistoryUse& use, Remarks& remarks);

/// Locks the process's memory. Call it after the history was made: otherwise the history's pages
/// would be faulted in one by one.
/// Errors  One line: it is refused and realtime.require is set.
[[nodiscard]] std::expected<void, std::string> lockMemory(const RealtimeSettings& realtime,
                                                          const FrameHistory& history,
                                                          Remarks& remarks);

}  // namespace appliance
