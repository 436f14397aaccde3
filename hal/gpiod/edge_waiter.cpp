#include "hal/gpiod/edge_waiter.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace hal::gpiod {
namespace {

constexpr std::size_t kBufferedEdges = 64;

timespec toTimespec(rt::Nanoseconds time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace

EdgeWaiter::EdgeWaiter(std::vector<::gpiod::line_request> requests)
    : requests_(std::move(requests)), buffer_(kBufferedEdges) {
  for (const auto& request : requests_) {
    polled_.push_back({.fd = request.fd(), .events = POLLIN, .revents = 0});
  }
}

std::optional<StampedEdge> EdgeWaiter::wait(rt::Nanoseconds timeout) {
  const rt::Timestamp end = rt::now() + timeout;
  while (edges_.empty()) {
    const rt::Nanoseconds left = end - rt::now();
    fetch(std::max(left, rt::Nanoseconds{0}));
    if (edges_.empty() && left <= rt::Nanoseconds{0}) return std::nullopt;
  }
  const StampedEdge edge = edges_.front();
  edges_.pop_front();
  return edge;
}

void EdgeWaiter::fetch(rt::Nanoseconds timeout) {
  const timespec longest = toTimespec(timeout);
  // Of a request that was dropped the descriptor is -1, which poll passes over.
  if (::ppoll(polled_.data(), polled_.size(), &longest, nullptr) <= 0) return;
  for (std::size_t i = 0; i < polled_.size(); ++i) {
    if (polled_[i].fd < 0 || polled_[i].revents == 0) continue;
    if ((polled_[i].revents & POLLIN) != 0) {
      read(i);
    } else {
      drop(i);  // an error or a hang-up, and nothing left to read
    }
  }
  std::ranges::stable_sort(edges_, {}, &StampedEdge::at);
}

void EdgeWaiter::read(std::size_t request) {
  try {
    (void)requests_[request].read_edge_events(buffer_);
    for (const ::gpiod::edge_event& event : buffer_) {
      const auto stamp_ns = static_cast<std::uint64_t>(event.timestamp_ns());
      edges_.push_back({.at = rt::fromNs(static_cast<std::int64_t>(stamp_ns)),
                        .request = request,
                        .offset = static_cast<unsigned>(event.line_offset()),
                        .active = event.type() == ::gpiod::edge_event::event_type::RISING_EDGE});
    }
  } catch (const std::exception&) {
    drop(request);
  }
}

void EdgeWaiter::drop(std::size_t request) {
  polled_[request].fd = -1;
  lost_ = true;
}

}  // namespace hal::gpiod
