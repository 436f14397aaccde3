#pragma once

#include <optional>

#include "appliance/director/command.h"
#include "rt/annotations.h"
#include "rt/event_bell.h"
#include "rt/spsc_ring.h"

namespace appliance {

/// Answers to commands, on their way from the render thread to the event loop of main. Each command
/// with an id has one, after the status that shows its effect was published.
///
/// Threads  give(), ring(): the render thread. tryTake(), fd(): main.
/// RT       give() is wait-free; ring() is one system call, made in turns with such a command only.
/// Errors   A full ring loses the newest answer and counts it: its sender gets an error after 1 s.
class CommandAnswers {
 public:
  void give(const CommandAnswer& answer) RT_SAFE { (void)ring_.tryPush(answer); }
  void ring() RT_SAFE { bell_.ring(); }

  [[nodiscard]] std::optional<CommandAnswer> tryTake() {
    (void)bell_.takeRings();
    return ring_.tryPop();
  }
  [[nodiscard]] int fd() const { return bell_.fd(); }
  [[nodiscard]] std::uint64_t lost() const { return ring_.dropped(); }

 private:
  rt::SpscRing<CommandAnswer, kMostCommands> ring_;
  rt::EventBell bell_;
};

}  // namespace appliance
