#include <sstream>

#include "appliance/tools/emulator_files.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(fuzz::text(data, size));
  std::istringstream wire_log(content);
  if (const auto frames = appliance::readWireLog(wire_log, "wire.csv"); !frames)
    fuzz::requireOneLine(frames.error());
  std::istringstream statistics(content);
  if (const auto read = appliance::readEmulatorStatistics(statistics, "emulator.json"); !read)
    fuzz::requireOneLine(read.error());
  return 0;
}
