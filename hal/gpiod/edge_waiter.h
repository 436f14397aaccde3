#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <gpiod.hpp>
#include <poll.h>

#include "rt/clock.h"

namespace hal::gpiod {

/// An edge of one of several requests.
struct StampedEdge {
  rt::Timestamp at;
  std::size_t request = 0;  ///< index among the requests
  unsigned offset = 0;
  bool active = false;
};

/// Waits for edges of several requests together and puts them in order of time.
///
/// Threads  One.
/// Errors   A request whose chip is gone is waited for no more; lost() says so.
class EdgeWaiter {
 public:
  explicit EdgeWaiter(std::vector<::gpiod::line_request> requests);

  /// The next edge, nothing after @p timeout.
  [[nodiscard]] std::optional<StampedEdge> wait(rt::Nanoseconds timeout);

  [[nodiscard]] ::gpiod::line_request& request(std::size_t index) { return requests_[index]; }
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  void fetch(rt::Nanoseconds timeout);
  void read(std::size_t request);
  void drop(std::size_t request);

  std::vector<::gpiod::line_request> requests_;
  std::vector<pollfd> polled_;
  ::gpiod::edge_event_buffer buffer_;
  std::deque<StampedEdge> edges_;
  bool lost_ = false;
};

}  // namespace hal::gpiod
