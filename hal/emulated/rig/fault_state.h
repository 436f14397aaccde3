#pragma once

#include <cstdint>
#include <optional>

#include "hal/emulated/rig/fault_command.h"
#include "rt/clock.h"

namespace emulator {

/// What one camera is doing wrong at the moment, beside what its wire does to packets. Pure.
class FaultState {
 public:
  /// Takes the faults that are a state; the camera does what is an act.
  void apply(const FaultCommand& command, rt::Timestamp now);

  /// Neither heard nor sends: its cable is pulled, or it starts up.
  [[nodiscard]] bool isDark(rt::Timestamp now) const { return killed_ || now < dark_until_; }
  /// Whose doing that is; kKill before kReboot.
  [[nodiscard]] Fault darkBecause() const { return killed_ ? Fault::kKill : Fault::kReboot; }
  [[nodiscard]] bool isFrozen() const { return frozen_; }
  [[nodiscard]] bool sendsWrongSize() const { return wrong_size_; }
  /// 0: as fast as it was built.
  [[nodiscard]] double linkMbps() const { return link_mbps_; }

  /// An edge came that the camera could follow: the fault that lets it pass, if one does.
  [[nodiscard]] std::optional<Fault> swallowEdge();

  [[nodiscard]] bool wantsExtraFrame() const { return extra_frames_ > 0; }
  void extraFrameTaken() { --extra_frames_; }
  /// How long the next frame is held back; zero after it was asked for.
  [[nodiscard]] rt::Nanoseconds takeHold();

 private:
  bool killed_ = false;
  bool frozen_ = false;
  bool wrong_size_ = false;
  rt::Timestamp dark_until_;
  double link_mbps_ = 0;
  rt::Nanoseconds hold_{0};
  std::uint32_t extra_frames_ = 0;
  std::uint32_t ignore_next_ = 0;
  std::uint32_t ignore_every_ = 0;
  std::uint32_t edges_since_ignored_ = 0;
};

}  // namespace emulator
