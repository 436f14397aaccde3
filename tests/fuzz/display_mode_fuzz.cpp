#include <cmath>

#include "tests/fuzz/fuzz_target.h"
#include "ui-kms/kms/mode_choice.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto spec = ui::kms::parseModeSpec(fuzz::text(data, size));
  if (!spec) {
    fuzz::requireOneLine(spec.error());
    return 0;
  }
  if (!*spec) return 0;
  fuzz::require((*spec)->width_px > 0 && (*spec)->height_px > 0, "a mode has a size");
  fuzz::require(std::isfinite((*spec)->refresh_hz) && (*spec)->refresh_hz >= 0,
                "and a rate or none");
  return 0;
}
