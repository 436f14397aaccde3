#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "rt/counter.h"
#include "rt/duration_window.h"

namespace appliance {

/// What a metric says at one moment: a count that only grows, a level, or durations.
using MetricValue = std::variant<std::uint64_t, double, rt::DurationSummary>;

struct Metric {
  std::string name;  ///< "GROUP.WHAT", for instance "trigger.missed"
  MetricValue value;
};

/// Every metric of the running daemon, sorted by name.
using MetricsSnapshot = std::vector<Metric>;

class MetricsRegistry;

/// The metrics of one part, in the registry while the group lives.
///
/// What is added outlives the group: hold the group as the last member, so that it goes first.
class [[nodiscard]] MetricsGroup {
 public:
  MetricsGroup() = default;
  MetricsGroup(MetricsGroup&& other) noexcept;
  MetricsGroup& operator=(MetricsGroup&& other) noexcept;
  ~MetricsGroup();

  void add(std::string_view what, const rt::Counter& counter);
  void add(std::string_view what, const rt::DurationWindow& durations);
  /// A figure that is kept elsewhere. @p count and @p level are called by snapshot().
  void addCount(std::string_view what, std::function<std::uint64_t()> count);
  void addLevel(std::string_view what, std::function<double()> level);

 private:
  friend class MetricsRegistry;
  MetricsGroup(MetricsRegistry& registry, std::uint64_t id, std::string name)
      : registry_(&registry), id_(id), name_(std::move(name)) {}
  void leave();
  void insert(std::string_view what, std::function<MetricValue()> read);

  MetricsRegistry* registry_ = nullptr;  // none: an empty group
  std::uint64_t id_ = 0;
  std::string name_;
};

/// The figures that the daemon keeps about itself, by name. Status, report, watchdog and tools
/// read the same ones. Parts add theirs while the box is set up and count with what is in rt/:
/// a real-time thread never comes here.
///
/// Threads  Any but a real-time one.
/// RT       Not safe: locks and allocates.
/// Errors   Two metrics of one name are our own bug.
class MetricsRegistry {
 public:
  MetricsRegistry() = default;
  MetricsRegistry(const MetricsRegistry&) = delete;
  MetricsRegistry& operator=(const MetricsRegistry&) = delete;

  /// @p name: lower_snake, for instance "trigger", "camera01".
  [[nodiscard]] MetricsGroup group(std::string name);

  [[nodiscard]] MetricsSnapshot snapshot() const;

 private:
  friend class MetricsGroup;
  struct Entry {
    std::uint64_t group;
    std::string name;
    std::function<MetricValue()> read;
  };

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;  // guarded by mutex_; sorted by name
  std::uint64_t groups_ = 0;    // likewise; so far
};

/// One value out of a snapshot; nothing when there is no such metric.
[[nodiscard]] const MetricValue* find(const MetricsSnapshot& metrics, std::string_view name);

}  // namespace appliance
