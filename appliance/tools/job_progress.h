#pragma once

#include <string>

#include "appliance/control/control_client.h"

namespace appliance {

/// Ctrl-C, SIGTERM and SIGHUP, kept for waitOne() as long as this object lives, so that a command
/// ends what it began before it ends itself. Made before the command begins anything.
///
/// Threads  One: the only one of the program.
class HeldSignals {
 public:
  HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  ~HeldSignals();

  /// The signal that came within @p milliseconds; 0: none.
  [[nodiscard]] int waitOne(int milliseconds) const;
};

/// Waits until the job at @p path has ended, and shows its progress on a terminal. A signal cancels
/// the job; then this waits for its end.
///
/// Errors   Prints one line and ends the command: the job failed, was cancelled, or cannot be
///          reached any more.
/// Returns the job's result.
[[nodiscard]] std::string followJob(ControlClient& client, const std::string& path,
                                    const HeldSignals& signals);

}  // namespace appliance
