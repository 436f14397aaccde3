#include "hal/emulated/rig/trigger_wire.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto edge = emulator::parseWireEdge(fuzz::text(data, size));
  if (edge) fuzz::require(edge->at >= rt::Timestamp{}, "an edge has an instant");
  return 0;
}
