#include "rt/printable.h"

#include <algorithm>
#include <cstdint>

namespace rt {
namespace {

/// How many bytes the character at the front takes; 0: none that may be shown.
std::size_t characterAt(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // No longer way to write a shorter one, no surrogates, nothing beyond the last code point, no C1
  // control characters.
  const std::uint8_t second = byte(1);
  const bool refused = (lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) ||
                       (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f) ||
                       (lead == 0xc2 && second < 0xa0);
  return refused ? 0 : bytes;
}

}  // namespace

std::string printable(std::string_view foreign, std::size_t longest) {
  std::string shown;
  shown.reserve(std::min(foreign.size(), longest) + 3);
  while (!foreign.empty()) {
    const std::size_t bytes = characterAt(foreign);
    if (shown.size() + std::max<std::size_t>(bytes, 1) > longest) return shown + "...";
    if (bytes == 0) {
      shown += '?';
    } else {
      shown += foreign.substr(0, bytes);
    }
    foreign.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return shown;
}

}  // namespace rt
