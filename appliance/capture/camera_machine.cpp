#include "appliance/capture/camera_machine.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "appliance/capture/liveness.h"

namespace appliance {
namespace {

constexpr std::uint32_t kWindow = 32;  // triggers over which a streaming camera is judged

/// How many of the newest judged triggers lie at or after @p first.
std::uint32_t judgedSince(const CameraFacts& facts, std::uint64_t first) {
  if (facts.fired < kTriggersOnTheWire + first) return 0;
  const std::uint64_t since = facts.fired - kTriggersOnTheWire - first + 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>({since, facts.judged, kWindow}));
}

/// How many of the newest @p triggers judged have no frame.
std::uint32_t missingOf(const CameraFacts& facts, std::uint32_t triggers) {
  const std::uint64_t window = (std::uint64_t{1} << triggers) - 1;  // kWindow is below 64
  return triggers - static_cast<std::uint32_t>(std::popcount(facts.brought & window));
}

}  // namespace

CameraAction CameraMachine::step(rt::Timestamp now, const CameraFacts& facts) {
  switch (phase_) {
    case Phase::kBusy:
      return CameraAction::kNone;
    case Phase::kClosed:
      return now < next_probe_ ? CameraAction::kNone : begin(CameraAction::kProbe);
    case Phase::kFree:
      return begin(CameraAction::kOpen);
    case Phase::kOpen:
      return begin(CameraAction::kStart);
    case Phase::kToClose:
      return begin(CameraAction::kClose);
    case Phase::kStreaming:
      return watch(now, facts);
    case Phase::kSilent:
      return search(now, facts);
  }
  return CameraAction::kNone;
}

CameraAction CameraMachine::begin(CameraAction action) {
  phase_ = Phase::kBusy;
  return action;
}

CameraAction CameraMachine::watch(rt::Timestamp now, const CameraFacts& facts) {
  const bool silent = facts.fired >= patient_until_ && !delivers(facts.stored, facts.fired);
  if (silent) {
    stored_when_silent_ = facts.stored;
    answered_ = false;
    proven_ = false;
    phase_ = Phase::kSilent;
    // The next probe shows what is wrong; until then the last known state stays.
    if (health_.state != CameraState::kLost) lose(CameraTrouble::kNone);
    next_probe_ = now;
    return search(now, facts);
  }
  proven_ ? judge(facts) : prove(facts);
  return phase_ == Phase::kToClose ? begin(CameraAction::kClose) : CameraAction::kNone;
}

CameraAction CameraMachine::search(rt::Timestamp now, const CameraFacts& facts) {
  if (facts.stored > stored_when_silent_) {  // it was away for a moment
    become(CameraState::kRecovering);
    expectFrom(facts);
    phase_ = Phase::kStreaming;
    return CameraAction::kNone;
  }
  if (!answered_) {
    patient_until_ = facts.fired + kFirstFrameWithin;  // its frames may follow its answer
  } else if (facts.fired >= patient_until_ && now >= next_try_) {
    next_try_ = now + kTryEvery;
    return begin(CameraAction::kClose);
  }
  return now < next_probe_ ? CameraAction::kNone : begin(CameraAction::kProbe);
}

/// Every trigger of the proof must have exactly one frame. Extra frames are counted for as many
/// triggers as the proof has, then from zero again: the first frames of a stream may be read too
/// late to be matched, which says nothing about the following ones.
void CameraMachine::prove(const CameraFacts& facts) {
  const std::uint32_t judged = judgedSince(facts, expected_from_);
  const std::uint32_t proof = std::min(kProofTriggers, facts.judged);
  if (proof == 0 || judged < proof) return;
  // Lost until it showed a frame.
  if (health_.state == CameraState::kLost && delivers(facts.stored, facts.fired)) {
    become(CameraState::kRecovering);
  }
  const bool counted = facts.fired >= proof_mark_.fired + proof + kTriggersOnTheWire;
  const bool too_many = facts.extra - proof_mark_.extra > proof / 4;
  if (counted && !too_many && missingOf(facts, proof) == 0) {
    proven_ = true;
    pushes_ = 0;
    mark_ = facts;
    become(CameraState::kStreaming);
    return;
  }
  if (counted && too_many) proof_mark_ = facts;
  if (facts.fired < expected_from_ + kProofPatience) return;
  if (pushes_ < kPushes) {
    phase_ = Phase::kToClose;
    return;
  }
  proven_ = true;  // as far as it goes
  become(CameraState::kDegraded, troubleIn(facts, missingOf(facts, judged)));
  mark_ = facts;
}

void CameraMachine::judge(const CameraFacts& facts) {
  if (facts.fired < mark_.fired + kWindow) return;
  const std::uint32_t judged = judgedSince(facts, expected_from_);
  const CameraTrouble trouble = troubleIn(facts, missingOf(facts, judged));
  const bool well = trouble == CameraTrouble::kNone;
  become(well ? CameraState::kStreaming : CameraState::kDegraded, trouble);
  if (well) pushes_ = 0;
  mark_ = facts;
}

/// Since the mark. One trigger in eight is a trouble; less is reported as lost frames.
CameraTrouble CameraMachine::troubleIn(const CameraFacts& facts, std::uint64_t missing) const {
  const std::uint64_t many = std::max<std::uint64_t>(judgedSince(facts, expected_from_) / 8, 2);
  if (facts.damaged - mark_.damaged >= many) return CameraTrouble::kDamaged;
  if (missing >= many) return CameraTrouble::kGaps;
  if (facts.extra - mark_.extra >= many) return CameraTrouble::kExtra;
  return CameraTrouble::kNone;
}

void CameraMachine::probed(rt::Timestamp now, const hal::CameraProbe& probe) {
  next_probe_ = now + kProbeEvery;
  if (probe.answer != hal::CameraAnswer::kHeld) seen_held_ = false;
  streams_ ? probedWhileOpen(probe) : probedWhileClosed(now, probe);
}

void CameraMachine::probedWhileOpen(const hal::CameraProbe& probe) {
  phase_ = Phase::kSilent;
  switch (probe.answer) {
    case hal::CameraAnswer::kNone:
      answered_ = false;
      lose(CameraTrouble::kNoAnswer);
      break;
    case hal::CameraAnswer::kFree:  // it forgot us
      become(CameraState::kRecovering);
      phase_ = Phase::kToClose;
      break;
    case hal::CameraAnswer::kHeld:
      // A camera that does not report its controller is probably still ours: releasing it will
      // show.
      if (!probe.controller.empty()) phase_ = Phase::kToClose;
      [[fallthrough]];
    case hal::CameraAnswer::kOurs:
      answered_ = true;
      lose(CameraTrouble::kSilent);
      break;
  }
}

void CameraMachine::probedWhileClosed(rt::Timestamp now, const hal::CameraProbe& probe) {
  phase_ = Phase::kClosed;
  switch (probe.answer) {
    case hal::CameraAnswer::kNone:
      lose(CameraTrouble::kNoAnswer);
      break;
    case hal::CameraAnswer::kFree:
      phase_ = Phase::kFree;
      // A camera that was tried in vain stays lost until it shows a frame.
      if (health_.state != CameraState::kConnecting && health_.trouble != CameraTrouble::kSilent &&
          health_.trouble != CameraTrouble::kRefuses) {
        become(CameraState::kRecovering);
      }
      break;
    case hal::CameraAnswer::kHeld:
    case hal::CameraAnswer::kOurs:  // a connection of ours that is still being closed
      settled_ = true;
      if (!std::exchange(seen_held_, true)) held_since_ = now;
      if (now - held_since_ >= kDeadControllerHolds) lose(CameraTrouble::kHeld, probe.controller);
      break;
  }
}

void CameraMachine::opened(rt::Timestamp now, const std::string& refused) {
  phase_ = refused.empty() ? Phase::kOpen : Phase::kClosed;
  if (refused.empty()) return;
  lose(CameraTrouble::kRefuses, refused);
  next_probe_ = now + kTryEvery;
}

void CameraMachine::started(rt::Timestamp now, const std::string& refused,
                            const CameraFacts& facts) {
  if (!refused.empty()) {
    lose(CameraTrouble::kRefuses, refused);
    next_try_ = now + kTryEvery;
    phase_ = Phase::kToClose;
    return;
  }
  settled_ = true;
  streams_ = true;
  ++pushes_;
  next_try_ = now + kTryEvery;
  expectFrom(facts);
  phase_ = Phase::kStreaming;
}

void CameraMachine::closed(rt::Timestamp now) {
  phase_ = Phase::kClosed;
  // A start that was refused is repeated later; any other camera is asked immediately.
  next_probe_ = health_.trouble == CameraTrouble::kRefuses ? next_try_ : now;
  streams_ = false;
}

void CameraMachine::expectFrom(const CameraFacts& facts) {
  proven_ = false;
  expected_from_ = facts.fired + 2;  // the next edge may be on its way already
  patient_until_ = facts.fired + kFirstFrameWithin;
  mark_ = proof_mark_ = facts;
}

void CameraMachine::lose(CameraTrouble trouble, std::string detail) {
  settled_ = true;
  health_ = {.state = CameraState::kLost, .trouble = trouble, .detail = std::move(detail)};
}

void CameraMachine::become(CameraState state, CameraTrouble trouble) {
  health_ = {.state = state, .trouble = trouble, .detail = {}};
}

}  // namespace appliance
