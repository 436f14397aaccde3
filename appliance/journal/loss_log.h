#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "rt/clock.h"

namespace appliance {

/// Decides when a growing count of losses is worth a line: the first loss immediately, later ones
/// as a sum each kPeriod. A bad cable loses some at every look.
///
/// Threads  main.
class LossLog {
 public:
  /// Least time between two lines about one key.
  static constexpr rt::Nanoseconds kPeriod = std::chrono::seconds(5);

  /// How many to report now for @p key, if any. @p total is its count so far. @p counts: false
  /// while the losses have another line of their own, such as a silent camera's.
  [[nodiscard]] std::optional<std::uint64_t> look(rt::Timestamp now, const std::string& key,
                                                  std::uint64_t total, bool counts);

 private:
  struct Seen {
    std::uint64_t total = 0;
    std::uint64_t unsaid = 0;
    std::optional<rt::Timestamp> said_at;
  };
  std::map<std::string, Seen> seen_;
};

}  // namespace appliance
