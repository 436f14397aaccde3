#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace emulator {

/// The faults that a camera can simulate.
enum class Fault : std::uint8_t {
  kIgnoreTriggers,  ///< the next N edges
  kIgnoreEvery,     ///< every N-th edge; 0: none
  kExtraFrame,      ///< one frame that no edge asked for
  kLateLeader,      ///< the next frame, held back whole, milliseconds
  kKill,            ///< the cable is pulled; the camera itself goes on
  kRevive,
  kReboot,  ///< dark for some seconds, then as switched on
  kFreeze,  ///< answers, but sends no frames
  kThaw,
  kWrongSize,  ///< frames of half their height
  kDrift,      ///< of the camera's clock, parts per million, beside its own few
  kLoss,       ///< of stream packets, percent
  kReorder,    ///< of stream packets, percent, each overtaken by the one behind it
  kDuplicate,  ///< of stream packets, percent
  kFrameId,    ///< of the next frame
  kLink,       ///< negotiated speed, Mb/s
  kMtu,        ///< of the path, bytes: larger datagrams vanish without a word
  kClear,      ///< everything that lasts, off
};

/// The word that stands for it in commands and in the fault log.
[[nodiscard]] std::string_view nameOf(Fault fault);

struct FaultCommand {
  std::optional<std::uint32_t> camera;  ///< from 0; nothing: all
  Fault fault = Fault::kClear;
  double argument = 0;  ///< in the unit of the fault; a switch: 0 or 1
  friend bool operator==(const FaultCommand&, const FaultCommand&) = default;
};

/// Reads "<camera from 1 | all> <fault> [argument]". An error is one line that says what is
/// wrong and what would be right. Pure.
[[nodiscard]] std::expected<FaultCommand, std::string> parseFaultCommand(std::string_view text,
                                                                         std::uint32_t cameras);

/// The command as parseFaultCommand() reads it, less the camera: "late-leader 25".
[[nodiscard]] std::string faultText(const FaultCommand& command);

}  // namespace emulator
