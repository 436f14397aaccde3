#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <systemd/sd-event.h>

#include "rt/clock.h"

namespace appliance {

/// The one loop of the main thread: signals, timers, descriptors and the bus connection.
///
/// One event is handled per turn. Signals and timers go before descriptors, descriptors before the
/// bus: a flood of D-Bus messages delays a timer by the one message that is being answered.
///
/// Threads  One: main. Create it before any other thread: it blocks the stop signals, and threads
///          inherit that.
/// RT       Not RT safe. A real-time thread wakes the loop through an rt::EventBell.
/// Errors   An exception in a handler ends run() with a line; it never crosses sd-event.
class EventLoop {
 public:
  using Handler = std::function<void()>;
  using Outcome = std::expected<void, std::string>;

  [[nodiscard]] static std::expected<std::unique_ptr<EventLoop>, std::string> create();

  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// INT, TERM and HUP end run(). A second one then ends the process immediately. HUP stays ignored
  /// if it was ignored before, as under nohup.
  [[nodiscard]] Outcome stopOnSignals();

  /// Calls @p handler every @p period. Calls that came late are not made up for.
  [[nodiscard]] Outcome every(rt::Nanoseconds period, Handler handler);

  /// Calls @p handler while @p fd is readable. The handler reads it; @p fd outlives the loop.
  [[nodiscard]] Outcome watch(int fd, Handler handler);

  /// Handles events until a stop signal or requestStop().
  [[nodiscard]] Outcome run();

  /// Waits for one event and handles it.
  [[nodiscard]] Outcome turn();

  void requestStop() { stopping_ = true; }

  /// For libraries that attach themselves; theirs is the priority kBusPriority.
  [[nodiscard]] sd_event* handle() const { return event_.get(); }
  static constexpr std::int64_t kBusPriority = SD_EVENT_PRIORITY_IDLE;

 private:
  struct EventCloser {
    void operator()(sd_event* event) const { sd_event_unref(event); }
  };
  struct SourceCloser {
    void operator()(sd_event_source* source) const { sd_event_source_disable_unref(source); }
  };
  struct Watched {
    EventLoop& loop;
    Handler handler;
    rt::Nanoseconds period;  // of a timer
    std::unique_ptr<sd_event_source, SourceCloser> source;
  };

  EventLoop() = default;
  Watched& add(Handler handler, rt::Nanoseconds period);
  Outcome added(int result, Watched& watched, sd_event_source* source, std::int64_t priority);
  void handle(const Watched& watched) noexcept;
  void onStopSignal() noexcept;

  std::unique_ptr<sd_event, EventCloser> event_;
  std::vector<std::unique_ptr<Watched>> watched_;
  std::vector<std::unique_ptr<sd_event_source, SourceCloser>> signals_;
  std::string fault_;  // of a handler
  bool stopping_ = false;
};

}  // namespace appliance
