#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <random>
#include <span>
#include <string_view>

#include "rt/clock.h"
#include "tests/soak/loss_account.h"

namespace soak {

/// The causes by which a fault may cost frames.
class Causes {
 public:
  constexpr Causes(std::initializer_list<LossCause> causes) {
    for (const LossCause cause : causes) bits_ |= 1U << static_cast<unsigned>(cause);
  }
  [[nodiscard]] constexpr bool has(LossCause cause) const {
    return (bits_ >> static_cast<unsigned>(cause) & 1U) != 0;
  }

 private:
  unsigned bits_ = 0;
};

/// One thing that goes wrong with a camera, in the words of kagami-emulator's fault port, and what
/// it may cost on that camera. Nothing may cost a frame on another one.
struct FaultKind {
  std::string_view name;
  std::string_view begin;
  std::string_view end;              ///< the command that undoes it; empty: over by itself
  rt::Nanoseconds lasts{};           ///< such a one; 0: until undone
  Causes may_lose{};                 ///< by which causes
  std::uint64_t most_frames = kAny;  ///< in all
  rt::Nanoseconds recovery{};        ///< frames may still be lost for this long afterwards
  bool named = false;                ///< the box must say that the camera does not stream

  static constexpr std::uint64_t kAny = UINT64_MAX;
};

[[nodiscard]] std::span<const FaultKind> faultKinds();
/// The one of that name; nullptr: there is none.
[[nodiscard]] const FaultKind* findFaultKind(std::string_view name);

/// The next thing to go wrong.
struct PlannedFault {
  const FaultKind* kind;
  std::uint32_t camera;  ///< from 0
  rt::Nanoseconds lasts;
};

/// Random faults, the same for the same seed: every kind of @p kinds once in random order, then
/// again. Pure.
class FaultPlan {
 public:
  /// @p every: from one fault's begin to the next; a fault lasts at most half of it.
  FaultPlan(std::span<const FaultKind> kinds, std::uint32_t cameras, rt::Nanoseconds every,
            std::uint64_t seed)
      : kinds_(kinds), cameras_(cameras), every_(every), engine_(seed) {}
  [[nodiscard]] PlannedFault next();

 private:
  std::span<const FaultKind> kinds_;
  std::uint32_t cameras_;
  rt::Nanoseconds every_;
  std::mt19937_64 engine_;
  std::deque<const FaultKind*> round_;
};

}  // namespace soak
