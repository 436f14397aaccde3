#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

#include "rt/unique_fd.h"

namespace test {

/// RGBA bytes, top row first.
struct ScannedOut {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::vector<std::byte> rgba;
};

/// Pixels whose red, green or blue differ; all of them where the sizes do.
[[nodiscard]] std::size_t differingPixels(const ScannedOut& a, const ScannedOut& b);

/// Reads the picture that a card really sends to its screen, by the card's writeback connector:
/// what the hardware composed at a vblank, not what a program believes it gave.
///
/// Writeback is a commit, and commits are the master's alone. So the reader works through the
/// display's own open descriptor, which it copies from the process that shows: its own, or another
/// one (a whole daemon), for which it must be root. It never reads events, which stay the
/// display's. A commit of the display that meets a read is refused as busy, and comes a vblank
/// later.
///
/// The first read after the display lit its screen attaches the writeback connector, which sets
/// the mode again: the grid of vblanks starts again there. The destructor detaches it, with the
/// same effect.
///
/// Errors   Everything throws std::runtime_error with what the kernel refused.
class ScanoutReader {
 public:
  /// Of the process @p pid, which has @p card open.
  ScanoutReader(pid_t pid, const std::string& card);
  ~ScanoutReader();
  ScanoutReader(const ScanoutReader&) = delete;
  ScanoutReader& operator=(const ScanoutReader&) = delete;

  /// What the next vblank scans out.
  [[nodiscard]] ScannedOut read();

 private:
  void detach();

  rt::UniqueFd fd_;
  std::uint32_t connector_ = 0;  // the writeback one
};

}  // namespace test
