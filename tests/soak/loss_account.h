#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "appliance/tools/emulator_files.h"
#include "appliance/trace/records.h"
#include "rt/clock.h"

namespace soak {

/// What became of a frame that the box did not store.
enum class LossCause : std::uint8_t {
  kNotSent,     ///< the camera sent none for this trigger
  kLateEdge,    ///< likewise, and its edge or the one before came late: the cameras were not ready
  kNeverCame,   ///< sent, but the box has no record of it
  kIncomplete,  ///< came with packets missing
  kHeldUp,      ///< likewise, and the emulator itself took longer for it than the box waits
  kWrongSize,   ///< came in another size than configured
  kUnattributed,  ///< came, but near no trigger edge, or aborted
};
inline constexpr std::size_t kLossCauses = 7;
[[nodiscard]] std::string_view nameOf(LossCause cause);

struct LostFrame {
  std::uint32_t camera = 0;
  LossCause cause = LossCause::kNeverCame;
  std::uint64_t trigger = 0;
  rt::Timestamp edge;
};

/// A frame that was stored as that of a trigger at whose edge it was not taken.
struct MisattributedFrame {
  std::uint32_t camera = 0;
  std::uint64_t trigger = 0;
  rt::Timestamp edge;
};

/// Holds a run's trace against the wire log of its cameras while both are being written: which
/// frames were lost, and what became of each. Pure.
///
/// Memory   What the two streams have not both passed yet, and the lost frames.
class LossAccount {
 public:
  /// @p period: between triggers.
  LossAccount(std::uint32_t cameras, rt::Nanoseconds period)
      : held_up_(period * 4 / 5), cameras_(cameras) {}

  /// Each kind in the order of its file.
  void triggerFired(const appliance::TriggerRecord& trigger);
  void frameArrived(const appliance::FrameRecord& frame);
  void frameSent(const appliance::SentFrame& frame);

  /// The streams have ended. Triggers after @p last_edge are not judged: their frames may have been
  /// on the wire when the cameras were stopped.
  void finish(rt::Timestamp last_edge);

  /// Triggers of this long after the first one are not judged: cameras find their pace.
  static constexpr rt::Nanoseconds kSettling = std::chrono::seconds(2);
  /// An edge this long after its deadline is late: this machine stood still.
  static constexpr rt::Nanoseconds kLate = std::chrono::milliseconds(2);
  /// A frame that was taken this near an edge shows its moment, whatever the camera took it for.
  static constexpr rt::Nanoseconds kSameMoment = std::chrono::milliseconds(2);
  /// No frame is on its way for longer.
  static constexpr rt::Nanoseconds kLongestWay = std::chrono::seconds(2);

  [[nodiscard]] const std::vector<LostFrame>& lost() const { return lost_; }
  [[nodiscard]] const std::vector<MisattributedFrame>& misattributed() const {
    return misattributed_;
  }
  [[nodiscard]] std::uint64_t triggersJudged() const { return triggers_judged_; }
  [[nodiscard]] std::uint64_t framesStored() const { return frames_stored_; }
  [[nodiscard]] std::uint64_t lostWhileSettling() const { return lost_while_settling_; }

 private:
  struct Arrived {
    std::uint64_t trigger;  // 0: not stored
    std::uint64_t wire_id;
    hal::FrameStatus status;
    rt::Timestamp at;
  };
  struct Camera {
    std::deque<appliance::SentFrame> sent;
    std::deque<appliance::SentFrame> passed;  // the last ones whose edge was judged
    std::deque<Arrived> stored;
    std::deque<Arrived> refused;
  };

  void judgePassed();
  static void pass(Camera& camera);
  void judge(const appliance::TriggerRecord& trigger);
  [[nodiscard]] static std::optional<appliance::SentFrame> sentFor(
      Camera& camera, const appliance::TriggerRecord& trigger);
  [[nodiscard]] static bool wasTakenElsewhere(const Camera& camera,
                                              const appliance::TriggerRecord& trigger,
                                              std::uint64_t wire_id);
  [[nodiscard]] static std::optional<std::uint64_t> storedFor(Camera& camera,
                                                              std::uint64_t trigger);
  [[nodiscard]] LossCause causeOf(Camera& camera, const appliance::TriggerRecord& trigger,
                                  const appliance::SentFrame& sent) const;

  const rt::Nanoseconds held_up_;  // [resend] frame_retention_us' default
  std::vector<Camera> cameras_;
  std::deque<appliance::TriggerRecord> triggers_;
  std::optional<rt::Timestamp> first_edge_;
  rt::Nanoseconds last_lateness_{};  // of the trigger judged before
  rt::Timestamp trace_passed_;
  rt::Timestamp wire_passed_;
  std::vector<LostFrame> lost_;
  std::vector<MisattributedFrame> misattributed_;
  std::uint64_t triggers_judged_ = 0;
  std::uint64_t frames_stored_ = 0;
  std::uint64_t lost_while_settling_ = 0;
};

}  // namespace soak
