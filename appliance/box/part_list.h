#pragma once

#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "appliance/box/part.h"
#include "rt/clock.h"

namespace appliance {

/// The parts of one box, walked in order: started first to last, stopped last to first.
///
/// A part that hangs in stop() keeps its thread and is never destroyed; what it uses must stay
/// until the process ends.
///
/// Threads  All members: main. Each stop() runs on a thread of its own, one at a time.
class PartList {
 public:
  static constexpr rt::Nanoseconds kPatience = std::chrono::seconds(10);

  /// @p patience: how long one part may take to stop.
  explicit PartList(rt::Nanoseconds patience = kPatience) : patience_(patience) {}
  ~PartList();
  PartList(const PartList&) = delete;
  PartList& operator=(const PartList&) = delete;

  void add(std::unique_ptr<Part> part) { parts_.push_back(std::move(part)); }

  /// Errors  One line of the part that does not start; it and those before it are stopped again.
  [[nodiscard]] std::expected<void, std::string> start();

  /// Idempotent. @return one line for each part that did not stop within its patience.
  std::vector<std::string> stop();
  /// Whether some part did not.
  [[nodiscard]] bool hung() const { return hung_; }

  void report(Status& status) const;

  void addBusObjects(std::vector<BusObject>& objects) const;

  /// The answer of the first part that the request belongs to; an error if it belongs to none.
  [[nodiscard]] std::expected<void, std::string> handle(const Request& request);

 private:
  [[nodiscard]] bool stopInTime(Part& part) const;

  const rt::Nanoseconds patience_;
  std::vector<std::unique_ptr<Part>> parts_;
  bool stopped_ = false;
  bool hung_ = false;
};

}  // namespace appliance
