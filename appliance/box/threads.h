#pragma once

#include <expected>
#include <functional>
#include <stop_token>
#include <string>

#include "appliance/box/remarks.h"
#include "appliance/config/thread_schedule.h"
#include "rt/thread.h"

namespace appliance {

/// Starts the parts' threads with their scheduling, and says what the system refused.
///
/// Threads  main.
class Threads {
 public:
  /// @p require: a thread without its real-time priority is an error, not a remark.
  Threads(bool require, Remarks& remarks) : require_(require), remarks_(remarks) {}

  /// Starts a thread and puts it into @p thread. @p name: as in the table of docs/real-time.md.
  /// Errors  One line: the thread cannot be made, or may not run as required. Then @p thread stays
  ///         as it was.
  [[nodiscard]] std::expected<void, std::string> startInto(
      rt::Thread& thread, const std::string& name, const ThreadSchedule& how,
      std::function<void(const std::stop_token&)> body);

 private:
  const bool require_;
  Remarks& remarks_;
};

}  // namespace appliance
