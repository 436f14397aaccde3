#pragma once

#include <cstdint>
#include <cstdio>
#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "hal/emulated/rig/fault_command.h"
#include "rt/clock.h"

namespace emulator {

/// What a fault did to one trigger or frame of one camera.
struct FaultEffect {
  Fault fault = Fault::kClear;
  std::uint64_t trigger = 0;
  std::uint16_t frame_id = 0;      ///< 0: no frame was made
  std::uint32_t packets_lost = 0;  ///< 0: the frame as a whole did not leave
};

/// Every fault that was commanded and everything that came of it, so that each frame a receiver
/// misses can be explained. CSV: instant_ns,camera,fault; cameras count from 1, the instants are
/// CLOCK_MONOTONIC.
///
/// A command is written immediately, as it was given ("late-leader 25"); its effects as
/// "effect <fault> trigger <n>[ frame <id>][ packets <lost>]", before the program ends.
class FaultLog {
 public:
  /// Creates the file and writes the header.
  [[nodiscard]] static std::expected<FaultLog, std::string> open(const std::string& path);

  void addCommand(rt::Timestamp at, std::uint32_t camera, const FaultCommand& command);
  void addEffect(rt::Timestamp at, std::uint32_t camera, const FaultEffect& effect);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  explicit FaultLog(std::FILE* file) : file_(file) {}
  void add(rt::Timestamp at, std::uint32_t camera, std::string_view text);
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace emulator
