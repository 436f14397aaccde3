#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "appliance/tools/distribution.h"
#include "appliance/trace/trace_file.h"

namespace appliance {

/// A live picture with a new frame set that came on screen.
struct FlippedTrigger {
  std::uint64_t trigger = 0;
  double edge_to_flip_ms = 0;
};

/// How the triggers stood to the screen. docs/trace.md says what each figure is.
struct GenlockReport {
  struct Unlock {
    std::uint64_t trigger = 0;
    GenlockReason reason = GenlockReason::kNone;
  };

  std::optional<GenlockState> state;  ///< at the end; nothing: the trace does not say
  GenlockReason reason = GenlockReason::kNone;
  std::uint32_t vblanks_per_trigger = 0;
  std::optional<double> locked_after_s;  ///< from the first trigger edge; nothing: never
  double locked_share = 0;               ///< of the triggers
  Distribution phase_error_us;           ///< its magnitude, while locked
  Distribution lead_ms;                  ///< while locked
  std::vector<Unlock> unlocks;
  /// Whole vblanks from trigger to page flip -> pictures, while locked.
  std::map<std::int64_t, std::uint64_t> trigger_to_flip_vblanks;
  Distribution edge_to_flip_locked_ms;
  Distribution edge_to_flip_free_ms;  ///< of all others
};

/// Pure.
[[nodiscard]] GenlockReport computeGenlockReport(const Trace& trace,
                                                 std::span<const FlippedTrigger> flipped);

}  // namespace appliance
