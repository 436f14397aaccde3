#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "appliance/director/command.h"
#include "appliance/director/command_answers.h"
#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/doorbell.h"
#include "rt/spsc_ring.h"

namespace appliance {

/// A command and when the person gave it.
struct CommandEvent {
  Command command;
  rt::Timestamp at;
  CommandId id = 0;
};

/// The end of the inbox that one thread gives its commands to.
///
/// Threads  give(): one thread. refused(): any.
/// RT       give() is wait-free but for one futex wake.
class CommandSender {
 public:
  CommandSender(std::string name, rt::Doorbell& bell) : name_(std::move(name)), bell_(bell) {}

  /// Hands the command over and wakes the taker. False: too many wait; it is refused and counted.
  bool give(const CommandEvent& event) RT_SAFE {
    const bool taken = ring_.tryPush(event);
    bell_.ring();
    return taken;
  }

  [[nodiscard]] std::uint64_t refused() const RT_SAFE { return ring_.dropped(); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  friend class CommandInbox;
  const std::string name_;
  rt::Doorbell& bell_;
  rt::SpscRing<CommandEvent, kMostCommands> ring_;
};

/// What persons and programs want to be shown, on its way to the render thread: one ring for each
/// thread that gives commands, and the bell that wakes the taker.
///
/// Threads  open(): the owner, before the taker runs. tryTake(): the render thread.
/// RT       tryTake() is wait-free.
/// Memory   The bell outlives the inbox, the inbox its senders' last command.
/// Errors   A full ring refuses the newest command and counts it.
class CommandInbox {
 public:
  /// @p bell: wakes the render thread.
  explicit CommandInbox(rt::Doorbell& bell) : bell_(bell) {}
  CommandInbox(const CommandInbox&) = delete;
  CommandInbox& operator=(const CommandInbox&) = delete;

  /// @p name: who gives, for the status: "panel".
  [[nodiscard]] CommandSender& open(std::string name) {
    senders_.push_back(std::make_unique<CommandSender>(std::move(name), bell_));
    return *senders_.back();
  }

  /// The oldest command of the first sender that has one, in the order in which they were opened.
  [[nodiscard]] std::optional<CommandEvent> tryTake() RT_SAFE {
    for (const auto& sender : senders_)
      if (const auto event = sender->ring_.tryPop()) return event;
    return std::nullopt;
  }

  /// The way back, for commands with an id.
  [[nodiscard]] CommandAnswers& answers() { return answers_; }
  [[nodiscard]] const CommandAnswers& answers() const { return answers_; }

  [[nodiscard]] const std::vector<std::unique_ptr<CommandSender>>& senders() const {
    return senders_;
  }

 private:
  rt::Doorbell& bell_;
  std::vector<std::unique_ptr<CommandSender>> senders_;
  CommandAnswers answers_;
};

}  // namespace appliance
