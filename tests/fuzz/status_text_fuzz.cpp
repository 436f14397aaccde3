#include "appliance/tools/status_text.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = appliance::statusText(std::string(fuzz::text(data, size)));
  if (!text) fuzz::requireOneLine(text.error());
  return 0;
}
