#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/openni/wire.h"
#include "rt/unique_fd.h"

namespace hal::openni {

/// The supervisor's view of one worker process: its pid, its socket and its pictures.
///
/// Threads  One caller.
class WorkerProcess {
 public:
  /// Starts this machine's kagami-depth, which lies beside the running program, as a worker.
  /// Errors  One line for a person: it is not there, or no process can be made.
  [[nodiscard]] static std::expected<WorkerProcess, std::string> start(
      const std::vector<std::string>& arguments);

  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&& other) noexcept;
  /// Lets it close its device, and kills it if that takes long.
  ~WorkerProcess();

  [[nodiscard]] int socket() const { return socket_.get(); }
  void kill();

  /// Maps the pictures that came with kHello; false: they are not as it says.
  [[nodiscard]] bool accept(const WireMessage& hello, rt::UniqueFd memory);
  [[nodiscard]] bool accepted() const { return memory_ != nullptr; }
  [[nodiscard]] const WireMessage& hello() const { return hello_; }

  [[nodiscard]] std::span<const std::uint16_t> depth(std::uint32_t slot) const;
  [[nodiscard]] std::span<const std::uint8_t> colour(std::uint32_t slot) const;
  void release(std::uint32_t slot);

 private:
  WorkerProcess(pid_t pid, rt::UniqueFd socket) : pid_(pid), socket_(std::move(socket)) {}

  pid_t pid_ = -1;
  rt::UniqueFd socket_;
  WireMessage hello_;
  std::byte* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace hal::openni
