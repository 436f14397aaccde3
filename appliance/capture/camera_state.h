#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "appliance/words/phrase.h"
#include "rt/clock.h"

namespace appliance {

enum class CameraState : std::uint8_t {
  kConnecting,  ///< being opened for the first time
  kStreaming,   ///< a frame for every trigger
  kDegraded,    ///< frames, but not one good frame for every trigger
  kLost,        ///< no frames
  kRecovering,  ///< it was lost, answers again and is being taken back
};

/// Why a camera does not simply stream.
enum class CameraTrouble : std::uint8_t {
  kNone,
  kNoAnswer,  ///< nothing answers at its address
  kHeld,      ///< another program controls it
  kRefuses,   ///< it answers, but does not take its settings or does not start
  kSilent,    ///< it answers and has its settings, but sends no frames
  kGaps,      ///< some triggers deliver no frame
  kDamaged,   ///< some frames come with packets missing, or in another size
  kExtra,     ///< it sends more frames than there are triggers
};

struct CameraHealth {
  CameraState state = CameraState::kConnecting;
  CameraTrouble trouble = CameraTrouble::kNone;
  std::string detail = {};  ///< who holds it, or what it refuses

  friend bool operator==(const CameraHealth&, const CameraHealth&) = default;
};

[[nodiscard]] constexpr std::string_view nameOf(CameraState state) {
  constexpr std::array<std::string_view, 5> kNames = {"connecting", "streaming", "degraded", "lost",
                                                      "recovering"};
  return kNames[static_cast<std::size_t>(state)];
}

[[nodiscard]] constexpr std::string_view nameOf(CameraTrouble trouble) {
  constexpr std::array<std::string_view, 8> kNames = {"none",   "no answer", "held",    "refuses",
                                                      "silent", "gaps",      "damaged", "extra"};
  return kNames[static_cast<std::size_t>(trouble)];
}

/// What is wrong and what to do; empty if nothing is. @p silent_for: since its last frame, of a
/// camera that had one.
[[nodiscard]] Phrase reasonOf(const CameraHealth& health,
                              std::optional<rt::Nanoseconds> silent_for);

}  // namespace appliance
