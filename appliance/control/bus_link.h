#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "appliance/control/bus.h"
#include "appliance/loop/event_loop.h"
#include "appliance/words/phrase.h"
#include "rt/clock.h"

namespace appliance {

/// The daemon's connection to a message bus under a well-known name, for as long as the daemon
/// runs: a bus that is not there, goes away or gives the name to another program is tried again.
///
/// Threads  The event loop's. Nothing here blocks.
/// Errors   trouble(), while there is no connection.
class BusLink {
 public:
  static constexpr rt::Nanoseconds kRetry = std::chrono::seconds(5);
  static constexpr rt::Nanoseconds kPatience = std::chrono::seconds(10);  // of a silent bus

  struct Events {
    std::function<int(sd_bus*)> offer;  ///< adds the objects; a negative errno refuses the bus
    std::function<void()> lost;         ///< the connection, and with it every caller, is gone
  };

  /// @p which: "system", "session" or a D-Bus address.
  BusLink(EventLoop& loop, std::string which, std::string name, Events events);
  BusLink(const BusLink&) = delete;
  BusLink& operator=(const BusLink&) = delete;
  ~BusLink();

  /// Connects, and again after a loss; call it at each tick.
  void look(rt::Timestamp now);

  /// The connection that owns the name; null if there is none.
  [[nodiscard]] sd_bus* bus() const { return owns_name_ ? bus_.get() : nullptr; }

  /// What is wrong and what to do; empty: nothing, or not known yet.
  [[nodiscard]] const Phrase& trouble() const { return trouble_; }

  /// "org.kagami.Kagami1 on the system bus"
  [[nodiscard]] std::string title() const { return name_ + " on " + describeBus(which_); }

 private:
  void connect(rt::Timestamp now);
  void close();
  void fail(const Phrase& trouble);
  void onName(sd_bus_message* reply);

  EventLoop& loop_;
  const std::string which_;
  const std::string name_;
  const Events events_;
  ServerBus bus_;  // null: not connected
  bool owns_name_ = false;
  bool failed_ = false;  // to be closed at the next look, outside of its own callbacks
  rt::Timestamp next_try_;
  rt::Timestamp patience_ends_;
  Phrase trouble_;
};

}  // namespace appliance
