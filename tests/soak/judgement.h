#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "appliance/trace/records.h"
#include "tests/soak/faults.h"
#include "tests/soak/loss_account.h"

namespace soak {

/// A fault as it was done to a camera.
struct Fault {
  const FaultKind* kind;
  std::uint32_t camera;  ///< from 0
  rt::Timestamp from;
  rt::Timestamp until;  ///< undone, or over by itself
  bool named = false;   ///< the box said meanwhile that this camera does not stream
};

/// What one fault cost.
struct FaultOutcome {
  Fault fault;
  std::array<std::uint64_t, kLossCauses> lost{};  ///< by LossCause; all explained
  rt::Nanoseconds back_after{};  ///< from its end to the camera's next stored frame
  [[nodiscard]] std::uint64_t lostFrames() const;
};

struct Judgement {
  std::vector<FaultOutcome> faults;
  /// On no faulty camera, by late edges, held up, or while the box's probes saw a stall.
  std::vector<LostFrame> stood_still;
  std::vector<LostFrame> unexplained;
};

/// Gives every lost frame to the fault that explains it: one on the same camera, at that time, that
/// may lose frames by that cause, and that has not lost its most frames already. Pure.
///
/// @p period: between triggers. A frame on its way when the fault began is the fault's.
/// @p stalls: when the machine itself stood still.
[[nodiscard]] Judgement judge(std::span<const LostFrame> lost, std::span<const Fault> faults,
                              std::span<const appliance::StallRecord> stalls,
                              rt::Nanoseconds period);

/// One line per fault, instants in seconds since @p start.
[[nodiscard]] std::string faultTable(const Judgement& judgement, rt::Timestamp start);
/// One line per kind of fault.
[[nodiscard]] std::string kindTable(const Judgement& judgement);
/// "camera 3, trigger 1234 at 56.789 s: never came".
[[nodiscard]] std::string describe(const LostFrame& lost, rt::Timestamp start);

}  // namespace soak
