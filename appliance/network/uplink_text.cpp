#include "appliance/network/uplink_text.h"

#include <charconv>
#include <string_view>

namespace appliance {

std::expected<Uplinks, std::string> parseUplinks(const std::string& text) {
  const auto refused = [&] {
    return std::unexpected(text + ": not of the form 10G, 2x10G or 100M, up to 64x400G");
  };
  Uplinks uplinks;
  std::string_view rest = text;
  if (const std::size_t times = rest.find('x'); times != std::string_view::npos) {
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + times, uplinks.count);
    if (error != std::errc{} || end != rest.data() + times) return refused();
    rest.remove_prefix(times + 1);
  }
  const auto [unit, error] = std::from_chars(rest.data(), rest.data() + rest.size(), uplinks.gbps);
  if (error != std::errc{}) return refused();
  rest.remove_prefix(static_cast<std::size_t>(unit - rest.data()));
  if (rest == "M")
    uplinks.gbps *= 1e-3;
  else if (rest != "G")
    return refused();
  const bool sane =
      uplinks.count >= 1 && uplinks.count <= 64 && uplinks.gbps >= 0.01 && uplinks.gbps <= 400;
  if (!sane) return refused();
  return uplinks;
}

}  // namespace appliance
