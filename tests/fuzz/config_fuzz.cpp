#include <vector>

#include "appliance/config/config.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

/// Lines from the first "--set" on are overrides, each as it stands behind that option.
constexpr std::string_view kOverride = "--set ";

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = fuzz::text(data, size);
  std::string file;
  std::vector<std::string> overrides;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1);
    const std::string_view line = rest.substr(0, end + 1);
    rest.remove_prefix(line.size());
    if (line.starts_with(kOverride)) {
      std::string override(line.substr(kOverride.size()));
      if (override.ends_with('\n')) override.pop_back();
      overrides.push_back(std::move(override));
    } else {
      file += line;
    }
  }
  const auto config = appliance::parseConfig(file, "kagamid.toml", overrides);
  if (!config) {
    fuzz::requireOneLine(config.error());
    return 0;
  }
  fuzz::require(config->trigger.rate_hz > 0, "the trigger has a rate");
  fuzz::require(config->display.width_px > 0 && config->display.height_px > 0,
                "the display has a size");
  return 0;
}
