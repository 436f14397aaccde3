#include "appliance/metrics/metrics_text.h"

#include <nlohmann/json.hpp>

namespace appliance {
namespace {

using nlohmann::ordered_json;

double us(rt::Nanoseconds time) {
  return static_cast<double>(time.count()) / 1e3;
}

struct ToObject {
  ordered_json operator()(std::uint64_t count) const { return count; }
  ordered_json operator()(double level) const { return level; }
  ordered_json operator()(const rt::DurationSummary& durations) const {
    return {{"count", durations.count},
            {"p50_us", us(durations.p50)},
            {"p95_us", us(durations.p95)},
            {"longest_us", us(durations.longest)},
            {"longest_ever_us", us(durations.longest_ever)}};
  }
};

}  // namespace

std::string toJson(const MetricsSnapshot& metrics) {
  ordered_json object = ordered_json::object();
  for (const Metric& metric : metrics) object[metric.name] = std::visit(ToObject(), metric.value);
  return object.dump();
}

}  // namespace appliance
