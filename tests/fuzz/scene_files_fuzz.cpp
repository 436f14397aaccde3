#include "hal/emulated/rig/convert_pose2sim.h"
#include "hal/emulated/rig/rig_file.h"
#include "tests/fuzz/fuzz_target.h"

/// A foreign calibration, and a scene's rig.toml; what is made of the first must be read as the
/// second.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content = fuzz::text(data, size);
  if (const auto rig = emulator::parseRigFile(content, "rig.toml"); !rig)
    fuzz::requireOneLine(rig.error());
  const auto converted = emulator::parseQualisys(content);
  if (!converted) {
    fuzz::requireOneLine(converted.error());
    return 0;
  }
  const auto read = emulator::parseRigFile(emulator::toToml(*converted), "rig.toml");
  fuzz::require(read && read->cameras.size() == converted->cameras.size(),
                "a converted calibration is read again");
  return 0;
}
