#include <cmath>

#include "hal/openni/folder_text.h"
#include "tests/fuzz/fuzz_target.h"

/// The two texts of a folder recording, sensor.toml and stamps.csv.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content = fuzz::text(data, size);
  if (const auto sensor = hal::openni::parseFolderSensor(content, "sensor.toml")) {
    fuzz::require(sensor->width_px > 0 && sensor->height_px > 0, "pictures have a size");
    const auto& lens = sensor->lens;
    for (const double px : {lens.focal_x_px, lens.focal_y_px, lens.centre_x_px, lens.centre_y_px})
      fuzz::require(std::isfinite(px) && px >= 0, "the lens is one");
    fuzz::require(sensor->rate_hz > 0, "the sensor has a rate");
    if (!sensor->name.empty()) fuzz::requireOneLine(sensor->name);
  } else {
    fuzz::requireOneLine(sensor.error());
  }
  const auto stamps = hal::openni::parseFolderStamps(content, "stamps.csv");
  if (!stamps) fuzz::requireOneLine(stamps.error());
  return 0;
}
