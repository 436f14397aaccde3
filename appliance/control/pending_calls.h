#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "appliance/director/command.h"
#include "rt/clock.h"

namespace appliance {

/// Callers that wait until their command was carried out: pure. @p Call is what answers one of
/// them.
///
/// Threads  One.
/// Memory   As many as the command ring holds, because a command that it refuses has no caller
/// here.
template <class Call>
class PendingCalls {
 public:
  void add(CommandId id, rt::Timestamp deadline, Call call) {
    waiting_.emplace(id, Waiting{deadline, std::move(call)});
  }

  /// The caller of that command; none if it gave up, or never waited.
  [[nodiscard]] std::optional<Call> take(CommandId id) {
    const auto found = waiting_.find(id);
    if (found == waiting_.end()) return std::nullopt;
    std::optional<Call> call(std::move(found->second.call));
    waiting_.erase(found);
    return call;
  }

  /// Those whose deadline is over.
  [[nodiscard]] std::vector<Call> takeOverdue(rt::Timestamp now) {
    std::vector<Call> overdue;
    for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
      if (now < waiting->second.deadline) {
        ++waiting;
        continue;
      }
      overdue.push_back(std::move(waiting->second.call));
      waiting = waiting_.erase(waiting);
    }
    return overdue;
  }

  void clear() { waiting_.clear(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }

 private:
  struct Waiting {
    rt::Timestamp deadline;
    Call call;
  };
  std::map<CommandId, Waiting> waiting_;
};

}  // namespace appliance
