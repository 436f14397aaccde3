#include "appliance/loop/event_loop.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <exception>
#include <utility>

#include <sys/epoll.h>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

constexpr std::array kStopSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::uint64_t kTimerAccuracy_us = 1000;
constexpr std::uint64_t kForever = UINT64_MAX;

std::uint64_t inMicroseconds(rt::Nanoseconds time) {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

std::unexpected<std::string> broken(int result) {
  return std::unexpected(withId(phrase<Word::kLoopFailed>(std::strerror(-result))));
}

bool isIgnored(int signal) {
  struct sigaction action{};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void maskStopSignals(int how) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : kStopSignals) sigaddset(&signals, signal);
  pthread_sigmask(how, &signals, nullptr);
}

}  // namespace

std::expected<std::unique_ptr<EventLoop>, std::string> EventLoop::create() {
  std::unique_ptr<EventLoop> loop(new EventLoop);
  sd_event* made = nullptr;
  if (const int r = sd_event_new(&made); r < 0) return broken(r);
  loop->event_.reset(made);
  maskStopSignals(SIG_BLOCK);
  return loop;
}

EventLoop::~EventLoop() = default;

EventLoop::Outcome EventLoop::stopOnSignals() {
  for (const int signal : kStopSignals) {
    if (signal == SIGHUP && isIgnored(signal)) continue;
    const auto handler = [](sd_event_source*, const signalfd_siginfo*, void* loop) {
      static_cast<EventLoop*>(loop)->onStopSignal();
      return 0;
    };
    sd_event_source* source = nullptr;
    const int r = sd_event_add_signal(event_.get(), &source, signal, handler, this);
    if (r < 0) return broken(r);
    signals_.emplace_back(source);
    sd_event_source_set_priority(source, SD_EVENT_PRIORITY_IMPORTANT);
  }
  return {};
}

/// From now on a stop signal has its default effect.
void EventLoop::onStopSignal() noexcept {
  requestStop();
  for (const auto& source : signals_) sd_event_source_set_enabled(source.get(), SD_EVENT_OFF);
  maskStopSignals(SIG_UNBLOCK);
}

EventLoop::Watched& EventLoop::add(Handler handler, rt::Nanoseconds period) {
  watched_.push_back(std::make_unique<Watched>(*this, std::move(handler), period, nullptr));
  return *watched_.back();
}

EventLoop::Outcome EventLoop::added(int result, Watched& watched, sd_event_source* source,
                                    std::int64_t priority) {
  if (result < 0) {
    watched_.pop_back();
    return broken(result);
  }
  watched.source.reset(source);
  sd_event_source_set_priority(source, priority);
  return {};
}

EventLoop::Outcome EventLoop::every(rt::Nanoseconds period, Handler handler) {
  const auto on_time = [](sd_event_source* source, std::uint64_t due_us, void* userdata) {
    const auto& watched = *static_cast<Watched*>(userdata);
    watched.loop.handle(watched);
    // sd_event_now() is when the turn began: before the handler ran.
    const std::uint64_t now_us = inMicroseconds(rt::now().time_since_epoch());
    sd_event_source_set_time(source, std::max(due_us + inMicroseconds(watched.period), now_us));
    return sd_event_source_set_enabled(source, SD_EVENT_ONESHOT);
  };
  Watched& watched = add(std::move(handler), period);
  sd_event_source* source = nullptr;
  const int r =
      sd_event_add_time_relative(event_.get(), &source, CLOCK_MONOTONIC, inMicroseconds(period),
                                 kTimerAccuracy_us, on_time, &watched);
  return added(r, watched, source, SD_EVENT_PRIORITY_IMPORTANT);
}

EventLoop::Outcome EventLoop::watch(int fd, Handler handler) {
  const auto on_input = [](sd_event_source*, int, std::uint32_t, void* userdata) {
    const auto& watched = *static_cast<Watched*>(userdata);
    watched.loop.handle(watched);
    return 0;
  };
  Watched& watched = add(std::move(handler), {});
  sd_event_source* source = nullptr;
  const int r = sd_event_add_io(event_.get(), &source, fd, EPOLLIN, on_input, &watched);
  return added(r, watched, source, SD_EVENT_PRIORITY_NORMAL);
}

void EventLoop::handle(const Watched& watched) noexcept {
  try {
    watched.handler();
  } catch (const std::exception& fault) {
    fault_ = fault.what();
  }
}

EventLoop::Outcome EventLoop::turn() {
  if (const int r = sd_event_run(event_.get(), kForever); r < 0) return broken(r);
  if (!fault_.empty()) return std::unexpected(withId(phrase<Word::kMainFailed>(fault_)));
  return {};
}

EventLoop::Outcome EventLoop::run() {
  while (!stopping_) {
    if (auto turned = turn(); !turned) return turned;
  }
  return {};
}

}  // namespace appliance
