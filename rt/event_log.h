#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/spsc_ring.h"

namespace rt {

/// What a real-time thread has to say: numbers, which another thread puts into words.
struct Event {
  std::uint32_t kind = 0;      ///< a value of the product's own enumeration
  std::uint32_t producer = 0;  ///< index of the thread that posted it
  Timestamp at;
  std::array<std::int64_t, 4> args{};  ///< meaning fixed per kind
};

/// One thread's end of the log.
/// Threads  post(): the producer's thread. lost(): any.
/// RT       post() is wait-free.
class EventProducer {
 public:
  EventProducer(std::uint32_t index, std::string name) : index_(index), name_(std::move(name)) {}

  /// A full log refuses the newest event and counts it.
  template <typename Kind>
    requires std::is_enum_v<Kind>
  void post(Kind kind, Timestamp at, const std::array<std::int64_t, 4>& args = {}) RT_SAFE {
    // A refusal shows in lost(): the poster has nothing else to do about it.
    (void)ring_.tryPush({static_cast<std::uint32_t>(kind), index_, at, args});
  }

  [[nodiscard]] std::uint64_t lost() const RT_SAFE { return ring_.dropped(); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  friend class EventLog;
  static constexpr std::uint32_t kCapacity = 1024;

  std::uint32_t index_;
  std::string name_;
  SpscRing<Event, kCapacity> ring_;
};

/// Events of all real-time threads, one ring per producer, brought together by a
/// thread that may format, log and wait.
///
/// Threads  addProducer() and drain(): the owner. Producers post on their own threads.
/// RT       Not safe; only EventProducer::post() is.
class EventLog {
 public:
  /// The reference holds as long as the log. Give it to the thread before it starts.
  [[nodiscard]] EventProducer& addProducer(std::string name) {
    const auto index = static_cast<std::uint32_t>(producers_.size());
    return *producers_.emplace_back(std::make_unique<EventProducer>(index, std::move(name)));
  }

  [[nodiscard]] const EventProducer& producer(std::uint32_t index) const {
    return *producers_.at(index);
  }

  /// What was posted since the last call, by time; one producer's events of the
  /// same instant keep their order.
  [[nodiscard]] std::vector<Event> drain() {
    std::vector<Event> events;
    for (auto& producer : producers_) {
      // At most one ring's worth, so that a busy producer cannot keep the drain here.
      for (std::uint32_t i = 0; i < EventProducer::kCapacity; ++i) {
        const auto event = producer->ring_.tryPop();
        if (!event) break;
        events.push_back(*event);
      }
    }
    std::ranges::stable_sort(events, {}, &Event::at);
    return events;
  }

  /// Events refused because the drain came too late, all producers together.
  [[nodiscard]] std::uint64_t lost() const noexcept {
    std::uint64_t sum = 0;
    for (const auto& producer : producers_) sum += producer->lost();
    return sum;
  }

 private:
  std::vector<std::unique_ptr<EventProducer>> producers_;
};

}  // namespace rt
