#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <expected>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "appliance/trace/records.h"
#include "rt/annotations.h"
#include "rt/spsc_ring.h"

namespace appliance {

/// The end of the trace that one thread writes into. A full ring refuses the record and counts it.
///
/// Threads  record(): one thread. The writer's own thread takes the other end.
/// RT       record() is wait-free.
class TraceProducer {
 public:
  /// @p name: whose records these are: "render".
  explicit TraceProducer(std::string name) : name_(std::move(name)) {}

  void record(const TraceRecord& record) RT_SAFE { (void)ring_.tryPush(record); }
  [[nodiscard]] std::uint64_t dropped() const RT_SAFE { return ring_.dropped(); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  friend class TraceWriter;
  const std::string name_;
  static constexpr std::uint32_t kRecords = 512;  // 12 s of one camera at 40 Hz
  rt::SpscRing<TraceRecord, kRecords> ring_;
};

/// Writes the trace file: one thread, SCHED_OTHER, empties the producers' rings a few times a
/// second. Producers never wait for it; what it is too slow for is dropped and counted.
///
/// Threads  failure(), dropped(): any. All other members: the owner. A producer: one thread.
/// Memory   All rings are made before begin(); the writer outlives its producers' last record().
/// Errors   A file that cannot be made or written: one line for a person. An error while running
///          ends the writing, not the daemon: failure() says it immediately, finish() again.
class TraceWriter {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<TraceWriter>, std::string> open(
      const std::string& path);

  /// The end for one more thread. Before begin().
  [[nodiscard]] TraceProducer& addProducer(std::string name);

  /// Writes the head and starts to drain. Until then the rings hold what is recorded: the
  /// threads that the head lists may already run.
  void begin(const RunRecord& run);

  ~TraceWriter() = default;  ///< without finish(): the records not yet written are gone
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Records that found a full ring so far, all producers together.
  [[nodiscard]] std::uint64_t dropped() const;

  /// Why nothing is written any more; empty: everything is.
  [[nodiscard]] std::string failure() const;

  /// After the producers' last record(): writes what is left, then the summary, and closes.
  [[nodiscard]] std::expected<void, std::string> finish(const SummaryRecord& summary);

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };

  TraceWriter(std::string path, std::FILE* file);
  void run(const std::stop_token& stop);
  void drain();
  void write(const std::string& text);
  void flush();
  void fail();

  std::string path_;
  std::unique_ptr<std::FILE, FileCloser> file_;
  std::atomic<int> write_errno_{0};  // the first one
  std::vector<std::unique_ptr<TraceProducer>> producers_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace appliance
