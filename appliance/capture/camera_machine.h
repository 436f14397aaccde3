#pragma once

#include <cstdint>
#include <string>

#include "appliance/capture/camera_state.h"
#include "hal/camera_probe.h"
#include "rt/clock.h"

namespace appliance {

/// What to do next with one camera.
enum class CameraAction : std::uint8_t {
  kNone,
  kProbe,  ///< ask its address; then probed()
  kOpen,   ///< open it and push its whole profile; then opened()
  kStart,  ///< stream into the history; then started()
  kClose,  ///< stop the stream and release the camera; then closed()
};

/// What the history says of one camera's frames.
struct CameraFacts {
  std::uint64_t fired = 0;   ///< newest trigger fired; 0: none yet
  std::uint64_t stored = 0;  ///< newest trigger with a stored frame of this camera
  std::uint64_t brought =
      0;                     ///< bit i: trigger fired - kTriggersOnTheWire - i has its frame stored
  std::uint32_t judged = 0;  ///< how many of these bits say something, 64 at most
  std::uint64_t damaged = 0;  ///< frames that came incomplete or in another size, so far
  std::uint64_t extra = 0;    ///< frames that came and belonged to no trigger, so far
};

/// One camera's life: found, opened, streaming, lost, recovered. Pure: it is given what happened
/// and when, and says what to do next.
///
/// A camera counts as lost when kLostAfterTriggers triggers passed without a frame; without
/// triggers nothing is lost. A silent camera is first asked over its address, because talking to a
/// dead one through an open connection takes seconds, and one that was away for a moment continues
/// by itself. It is closed only if it answers and is free (it forgot us: it is opened again), is
/// held by another program, or is ours but silent. After a start, kProofTriggers consecutive
/// triggers must each deliver exactly one frame; only then it streams. Otherwise the profile is
/// pushed again, up to kPushes times; after that its frames are accepted as they come, and it
/// counts as degraded.
///
/// Threads  One.
class CameraMachine {
 public:
  static constexpr rt::Nanoseconds kProbeEvery = std::chrono::milliseconds(100);
  /// After a refusal, or for a camera that is ours and silent: no faster than this.
  static constexpr rt::Nanoseconds kTryEvery = std::chrono::seconds(1);
  /// A controller that died holds a camera until its heartbeat runs out, after 3 s by default.
  static constexpr rt::Nanoseconds kDeadControllerHolds = std::chrono::seconds(5);
  static constexpr std::uint32_t kProofTriggers = 8;
  static constexpr std::uint32_t kProofPatience = 32;  ///< triggers within which they must come
  static constexpr std::uint32_t kPushes = 3;          ///< starts before a proof is given up
  /// After a start, or an answer, the first frame may take this many triggers.
  static constexpr std::uint64_t kFirstFrameWithin = 20;

  /// What to do now. After an action its outcome must be reported before the next call.
  [[nodiscard]] CameraAction step(rt::Timestamp now, const CameraFacts& facts);

  void probed(rt::Timestamp now, const hal::CameraProbe& probe);
  /// @p refused: what is wrong; empty: it is open.
  void opened(rt::Timestamp now, const std::string& refused);
  void started(rt::Timestamp now, const std::string& refused, const CameraFacts& facts);
  void closed(rt::Timestamp now);

  [[nodiscard]] const CameraHealth& health() const { return health_; }
  /// Whether its first attempt has ended, well or not.
  [[nodiscard]] bool settled() const { return settled_; }

 private:
  enum class Phase : std::uint8_t {
    kClosed,
    kFree,       // answered: to be opened
    kOpen,       // to be started
    kStreaming,  // frames are expected
    kSilent,     // streams, and no frames come
    kToClose,
    kBusy,  // an action's outcome is awaited
  };

  [[nodiscard]] CameraAction begin(CameraAction action);
  [[nodiscard]] CameraAction watch(rt::Timestamp now, const CameraFacts& facts);
  [[nodiscard]] CameraAction search(rt::Timestamp now, const CameraFacts& facts);
  void prove(const CameraFacts& facts);
  void judge(const CameraFacts& facts);
  void lose(CameraTrouble trouble, std::string detail = {});
  void become(CameraState state, CameraTrouble trouble = CameraTrouble::kNone);
  void expectFrom(const CameraFacts& facts);
  void probedWhileOpen(const hal::CameraProbe& probe);
  void probedWhileClosed(rt::Timestamp now, const hal::CameraProbe& probe);
  [[nodiscard]] CameraTrouble troubleIn(const CameraFacts& facts, std::uint64_t missing) const;

  Phase phase_ = Phase::kClosed;
  CameraHealth health_;
  bool settled_ = false;
  bool streams_ = false;    // started and not yet closed
  bool proven_ = false;     // since the last start or silence
  bool answered_ = false;   // while silent: it is there, and probably ours
  bool seen_held_ = false;  // and since when
  std::uint32_t pushes_ = 0;
  rt::Timestamp held_since_;
  rt::Timestamp next_probe_;
  rt::Timestamp next_try_;
  std::uint64_t expected_from_ = 0;  // triggers from this one on must deliver frames
  std::uint64_t patient_until_ = 0;  // silence before this trigger is no loss
  std::uint64_t stored_when_silent_ = 0;
  CameraFacts mark_;        // facts when the present window of judging began
  CameraFacts proof_mark_;  // and when counting frames beside those of a proof began
};

}  // namespace appliance
