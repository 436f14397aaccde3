#include "hal/emulated/scripted_panel.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto script = hal::emulated::parsePanelScript(fuzz::text(data, size), "panel.txt");
  if (!script) {
    fuzz::requireOneLine(script.error());
    return 0;
  }
  fuzz::require(std::ranges::is_sorted(*script, {}, &hal::emulated::ScriptedChange::after),
                "changes are in order of time");
  fuzz::require(script->empty() || script->front().after >= rt::Nanoseconds{0},
                "nothing happens before the start");
  return 0;
}
