#include "hal/emulated/rig/fault_command.h"
#include "tests/fuzz/fuzz_target.h"

/// What is understood reads the same when it is written out again.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint32_t kCameras = 20;
  const auto command = emulator::parseFaultCommand(fuzz::text(data, size), kCameras);
  if (!command) {
    fuzz::requireOneLine(command.error());
    return 0;
  }
  fuzz::require(!command->camera || *command->camera < kCameras, "the camera exists");
  const std::string camera = command->camera ? std::to_string(*command->camera + 1) : "all";
  const auto again =
      emulator::parseFaultCommand(camera + " " + emulator::faultText(*command), kCameras);
  fuzz::require(again && again->camera == command->camera && again->fault == command->fault,
                "a command that was written out is understood");
  return 0;
}
