#include "appliance/depth/latency.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kLongest = 300ms;
constexpr rt::Nanoseconds kStep = 100us;
constexpr std::size_t kFewestChanges = 20;
constexpr double kFollows = 0.9;

/// Pearson's correlation of brightness and lamp.
double correlation(std::span<const LampSample> samples, std::span<const LampChange> changes,
                   rt::Nanoseconds latency) {
  double n = 0;
  double sum_b = 0;
  double sum_l = 0;
  double sum_bb = 0;
  double sum_bl = 0;
  auto next = changes.begin();
  for (const LampSample& sample : samples) {
    const rt::Timestamp taken = sample.at - latency;
    while (next != changes.end() && next->at <= taken) ++next;
    if (next == changes.begin()) continue;  // not known yet
    const double lamp = (next - 1)->on ? 1 : 0;
    n += 1;
    sum_b += sample.brightness;
    sum_l += lamp;
    sum_bb += sample.brightness * sample.brightness;
    sum_bl += sample.brightness * lamp;
  }
  const double variance_b = n * sum_bb - sum_b * sum_b;
  const double variance_l = n * sum_l - sum_l * sum_l;  // lamp is its own square
  if (!(variance_b > 0) || !(variance_l > 0)) return 0;
  return (n * sum_bl - sum_b * sum_l) / std::sqrt(variance_b * variance_l);
}

}  // namespace

std::expected<MeasuredLatency, std::string> measureLatency(std::span<const LampSample> samples,
                                                           std::span<const LampChange> changes) {
  MeasuredLatency best;
  rt::Nanoseconds best_until{};
  for (const LampChange& change : changes) {
    if (!samples.empty() && change.at > samples.front().at && change.at < samples.back().at)
      ++best.changes;
  }
  if (best.changes < kFewestChanges) {
    return std::unexpected("the lamp changed " + std::to_string(best.changes) +
                           " times while pictures came: let it change at least " +
                           std::to_string(kFewestChanges) + " times");
  }
  for (rt::Nanoseconds latency{0}; latency <= kLongest; latency += kStep) {
    const double found = correlation(samples, changes, latency);
    if (found > best.correlation) {
      best.correlation = found;
      best.latency = best_until = latency;
    } else if (found == best.correlation) {
      best_until = latency;  // as good: no picture lies between
    }
  }
  if (!(best.correlation >= kFollows)) {
    return std::unexpected(
        "the pictures do not follow the lamp: is it in the sensor's view, large and bright "
        "against the room?");
  }
  best.latency += (best_until - best.latency) / 2;
  return best;
}

}  // namespace appliance
