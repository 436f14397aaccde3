#include <cmath>

#include "tests/fuzz/fuzz_target.h"
#include "ui-kms/kms/mode_choice.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto wish = ui::kms::parseModeWish(fuzz::text(data, size));
  if (!wish) {
    fuzz::requireOneLine(wish.error());
    return 0;
  }
  if (!*wish) return 0;
  fuzz::require((*wish)->width_px > 0 && (*wish)->height_px > 0, "a mode has a size");
  fuzz::require(std::isfinite((*wish)->refresh_hz) && (*wish)->refresh_hz >= 0,
                "and a rate or none");
  return 0;
}
