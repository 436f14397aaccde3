#include "appliance/metrics/metrics_registry.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace appliance {

MetricsGroup::MetricsGroup(MetricsGroup&& other) noexcept
    : registry_(std::exchange(other.registry_, nullptr)),
      id_(other.id_),
      name_(std::move(other.name_)) {}

MetricsGroup& MetricsGroup::operator=(MetricsGroup&& other) noexcept {
  if (this == &other) return *this;
  leave();
  registry_ = std::exchange(other.registry_, nullptr);
  id_ = other.id_;
  name_ = std::move(other.name_);
  return *this;
}

MetricsGroup::~MetricsGroup() {
  leave();
}

void MetricsGroup::leave() {
  if (registry_ == nullptr) return;
  const std::scoped_lock lock(registry_->mutex_);
  std::erase_if(registry_->entries_, [this](const auto& entry) { return entry.group == id_; });
  registry_ = nullptr;
}

void MetricsGroup::add(std::string_view what, const rt::Counter& counter) {
  insert(what, [&counter] { return MetricValue(counter.value()); });
}

void MetricsGroup::add(std::string_view what, const rt::DurationWindow& durations) {
  insert(what, [&durations] { return MetricValue(durations.summary()); });
}

void MetricsGroup::addCount(std::string_view what, std::function<std::uint64_t()> count) {
  insert(what, [count = std::move(count)] { return MetricValue(count()); });
}

void MetricsGroup::addLevel(std::string_view what, std::function<double()> level) {
  insert(what, [level = std::move(level)] { return MetricValue(level()); });
}

void MetricsGroup::insert(std::string_view what, std::function<MetricValue()> read) {
  assert(registry_ != nullptr && "an empty group has no registry");
  std::string name = name_ + "." + std::string(what);
  const std::scoped_lock lock(registry_->mutex_);
  auto& entries = registry_->entries_;
  const auto place =
      std::ranges::lower_bound(entries, name, {}, [](const auto& entry) { return entry.name; });
  assert((place == entries.end() || place->name != name) && "two metrics of one name");
  entries.insert(place, {.group = id_, .name = std::move(name), .read = std::move(read)});
}

MetricsGroup MetricsRegistry::group(std::string name) {
  const std::scoped_lock lock(mutex_);
  return {*this, ++groups_, std::move(name)};
}

MetricsSnapshot MetricsRegistry::snapshot() const {
  const std::scoped_lock lock(mutex_);
  MetricsSnapshot metrics;
  metrics.reserve(entries_.size());
  for (const Entry& entry : entries_) metrics.push_back({entry.name, entry.read()});
  return metrics;
}

const MetricValue* find(const MetricsSnapshot& metrics, std::string_view name) {
  const auto found = std::ranges::lower_bound(
      metrics, name, {}, [](const Metric& metric) { return std::string_view(metric.name); });
  return found != metrics.end() && found->name == name ? &found->value : nullptr;
}

}  // namespace appliance
