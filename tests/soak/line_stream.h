#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "rt/unique_fd.h"

namespace soak {

/// What another program writes into a file, line by line while it writes: the file is a pipe, so
/// that hours of it take no room.
///
/// Threads  Its own one calls @p take.
class LineStream {
 public:
  using Take = std::function<void(std::string_view line)>;

  /// Makes the pipe; the other program may open it from now on. A last line without its end is not
  /// taken.
  LineStream(const std::filesystem::path& path, Take take);
  ~LineStream();
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// False: the pipe could not be made.
  [[nodiscard]] bool open() const { return fd_.valid(); }
  /// Waits for the writer's end.
  void join();

 private:
  void read();

  Take take_;
  rt::UniqueFd fd_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace soak
