#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "rt/clock.h"

namespace emulator {

/// How late sends were, in steps of 10 us up to 100 ms; the largest one exactly.
class LatenessHistogram {
 public:
  void add(rt::Nanoseconds lateness);
  /// The upper edge of the step that holds the @p fraction quantile; zero when empty.
  [[nodiscard]] rt::Nanoseconds quantile(double fraction) const;
  [[nodiscard]] rt::Nanoseconds max() const { return max_; }

 private:
  static constexpr rt::Nanoseconds kStep{10'000};
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(10'000);
  std::uint64_t total_ = 0;
  rt::Nanoseconds max_{0};
};

/// What happened in one run; the ground truth that a receiver is measured against.
struct Counters {
  std::uint64_t triggers = 0;  ///< rising edges of Line1
  std::uint64_t frames_sent = 0;
  std::uint64_t overtriggers = 0;      ///< edges that a camera could not follow
  std::uint64_t send_failures = 0;     ///< packets the kernel refused for good
  std::uint64_t frames_cut_short = 0;  ///< stopped by the controller while being sent
  std::uint64_t packets_lost_on_purpose = 0;
  std::uint64_t packets_doubled = 0;             ///< by a fault
  std::uint64_t packets_overtaken = 0;           ///< by the one behind, by a fault
  std::uint64_t frames_withheld_on_purpose = 0;  ///< edges that a fault kept from giving a frame
  std::uint64_t faults_commanded = 0;
  std::uint64_t packets_resent = 0;
  std::uint64_t resends_unavailable = 0;  ///< asked for a frame that is no longer kept
  std::uint64_t wire_errors = 0;          ///< datagrams on the trigger wire that are no edge
  std::uint64_t bytes_sent = 0;
  int last_send_errno = 0;
};

/// The instants of one frame, each taken just before the system call that did it.
struct SentFrame {
  std::uint32_t camera;  ///< from 0
  std::uint16_t frame_id;
  std::uint64_t trigger;
  rt::Timestamp trigger_edge;
  rt::Timestamp exposure_end;
  rt::Timestamp first_packet;
  rt::Timestamp last_packet;
};

/// One CSV line per frame sent; complete after close.
class WireLog {
 public:
  /// Creates the file and writes the header.
  [[nodiscard]] static std::expected<WireLog, std::string> open(const std::string& path);
  void add(const SentFrame& frame);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  explicit WireLog(std::FILE* file) : file_(file) {}
  std::unique_ptr<std::FILE, Closer> file_;
};

/// All of a run that says whether it was valid.
///
/// The warm-up is the first seconds after the first edge. What happens in it is reported and not
/// judged; count frames from its end on, too. A run that ends within its warm-up is judged as a
/// whole.
struct RunRecord {
  Counters counters;
  LatenessHistogram lateness;             ///< of sends since the warm-up
  rt::Nanoseconds warm_up{0};             ///< how long it was to last
  std::uint64_t early_overtriggers = 0;   ///< of counters, in the warm-up
  std::uint64_t early_send_failures = 0;  ///< of counters, in the warm-up
  LatenessHistogram early_lateness;       ///< of sends in the warm-up

  /// Now. Allocates nothing.
  void endWarmUp();
};

/// Why a run measured the emulator instead of the receiver; empty when it is valid.
///
/// Limits: no edge ignored, no packet refused, p99 of the send lateness <= 5 ms (a fifth of
/// the period at 40 Hz), none later than one trigger period (@p period zero: not known).
[[nodiscard]] std::string invalidReason(const RunRecord& run, rt::Nanoseconds period);

/// CPU time of this process so far, user and system.
[[nodiscard]] double processCpuSeconds();

/// Writes the JSON that --stats asks for. @p cpu_seconds  spent while serving.
[[nodiscard]] std::expected<void, std::string> writeStatistics(const std::string& path,
                                                               std::uint32_t cameras,
                                                               const RunRecord& run,
                                                               rt::Nanoseconds period,
                                                               double cpu_seconds);

}  // namespace emulator
