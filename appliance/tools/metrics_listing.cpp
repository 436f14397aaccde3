#include "appliance/tools/metrics_listing.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace appliance {
namespace {

using nlohmann::ordered_json;

template <class... Arguments>
std::string text(const char* format, Arguments... arguments) {
  std::array<char, 200> line{};
  (void)std::snprintf(line.data(), line.size(), format, arguments...);
  return line.data();
}

std::string valueText(const ordered_json& value) {
  if (value.is_number_integer()) return text("%lld", value.get<long long>());
  if (value.is_number()) return text("%.6g", value.get<double>());
  if (!value.is_object()) return value.dump();
  const auto number = [&](const char* name) {
    const auto found = value.find(name);
    return found != value.end() && found->is_number() ? found->get<double>() : 0.0;
  };
  return text("%.0f times; us: half %.1f, 95 %% %.1f, longest %.1f, ever %.1f", number("count"),
              number("p50_us"), number("p95_us"), number("longest_us"), number("longest_ever_us"));
}

}  // namespace

std::expected<std::string, std::string> metricsListing(const std::string& json) {
  const auto metrics = ordered_json::parse(json, nullptr, false);
  if (!metrics.is_object()) return std::unexpected("the metrics are not JSON: other versions?");
  std::size_t width = 0;
  for (const auto& [name, value] : metrics.items()) width = std::max(width, name.size());
  std::string listing;
  for (const auto& [name, value] : metrics.items()) {
    listing += name + std::string(width + 2 - name.size(), ' ') + valueText(value) + "\n";
  }
  return listing;
}

std::string withMetrics(const std::string& status, const std::string& metrics) {
  auto whole = ordered_json::parse(status, nullptr, false);
  auto figures = ordered_json::parse(metrics, nullptr, false);
  if (!whole.is_object() || !figures.is_object()) return status;
  whole["metrics"] = std::move(figures);
  return whole.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace appliance
