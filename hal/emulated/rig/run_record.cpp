#include "hal/emulated/rig/run_record.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace emulator {
namespace {

constexpr rt::Nanoseconds kLateP99Limit{5'000'000};

std::string milliseconds(rt::Nanoseconds t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f ms", static_cast<double>(t.count()) * 1e-6);
  return text;
}

nlohmann::ordered_json quantilesOf(const LatenessHistogram& lateness) {
  return {{"p50", lateness.quantile(0.5).count()},
          {"p99", lateness.quantile(0.99).count()},
          {"max", lateness.max().count()}};
}

}  // namespace

double processCpuSeconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void LatenessHistogram::add(rt::Nanoseconds lateness) {
  lateness = std::max(lateness, rt::Nanoseconds{0});
  const auto step =
      std::min<std::size_t>(static_cast<std::size_t>(lateness / kStep), counts_.size() - 1);
  ++counts_[step];
  ++total_;
  max_ = std::max(max_, lateness);
}

rt::Nanoseconds LatenessHistogram::quantile(double fraction) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counts_.size() && total_ > 0; ++i) {
    seen += counts_[i];
    if (seen >= wanted) return std::min(kStep * static_cast<std::int64_t>(i + 1), max_);
  }
  return max_;
}

std::expected<WireLog, std::string> WireLog::open(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr) {
    return std::unexpected("cannot write the wire log " + path + ": " + std::strerror(errno));
  }
  std::setvbuf(file, nullptr, _IOFBF, 1 << 18);
  std::fputs(
      "camera,frame_id,trigger,trigger_edge_ns,exposure_end_ns,first_packet_ns,last_packet_ns\n",
      file);
  return WireLog(file);
}

void WireLog::add(const SentFrame& f) {
  std::fprintf(file_.get(),
               "%" PRIu32 ",%u,%" PRIu64 ",%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 "\n",
               f.camera, unsigned{f.frame_id}, f.trigger, rt::toNs(f.trigger_edge),
               rt::toNs(f.exposure_end), rt::toNs(f.first_packet), rt::toNs(f.last_packet));
}

void RunRecord::endWarmUp() {
  early_overtriggers = counters.overtriggers;
  early_send_failures = counters.send_failures;
  std::swap(lateness, early_lateness);
}

std::string invalidReason(const RunRecord& run, rt::Nanoseconds period) {
  const LatenessHistogram& lateness = run.lateness;
  if (const auto late = run.counters.overtriggers - run.early_overtriggers; late > 0) {
    return std::to_string(late) +
           " trigger edges came before a camera could follow: lower the trigger rate, the exposure "
           "or the packet delay";
  }
  if (const auto refused = run.counters.send_failures - run.early_send_failures; refused > 0) {
    return std::to_string(refused) +
           " packets could not be sent: " + std::strerror(run.counters.last_send_errno);
  }
  if (const auto p99 = lateness.quantile(0.99); p99 > kLateP99Limit) {
    return "packets left late: p99 " + milliseconds(p99) + " is over " +
           milliseconds(kLateP99Limit) + "; this machine is too slow or too busy for the load";
  }
  if (period.count() > 0 && lateness.max() > period) {
    return "a packet left " + milliseconds(lateness.max()) + " late, over one trigger period (" +
           milliseconds(period) + "); this machine is too slow or too busy for the load";
  }
  return {};
}

std::expected<void, std::string> writeStatistics(const std::string& path, std::uint32_t cameras,
                                                 const RunRecord& run, rt::Nanoseconds period,
                                                 double cpu_seconds) {
  const Counters& counters = run.counters;
  const std::string reason = invalidReason(run, period);
  const nlohmann::ordered_json json = {
      {"cameras", cameras},
      {"triggers", counters.triggers},
      {"frames_sent", counters.frames_sent},
      {"overtriggers", counters.overtriggers},
      {"pacing_late_ns", quantilesOf(run.lateness)},
      {"send_failures", counters.send_failures},
      {"valid", reason.empty()},
      {"invalid_reason", reason},
      {"cpu_seconds", cpu_seconds},
      {"bytes_sent", counters.bytes_sent},
      {"frames_cut_short", counters.frames_cut_short},
      {"packets_lost_on_purpose", counters.packets_lost_on_purpose},
      {"packets_doubled", counters.packets_doubled},
      {"packets_overtaken", counters.packets_overtaken},
      {"frames_withheld_on_purpose", counters.frames_withheld_on_purpose},
      {"faults_commanded", counters.faults_commanded},
      {"packets_resent", counters.packets_resent},
      {"resends_unavailable", counters.resends_unavailable},
      {"wire_errors", counters.wire_errors},
      {"trigger_period_ns", period.count()},
      {"warm_up",
       {{"seconds", std::chrono::duration<double>(run.warm_up).count()},
        {"overtriggers", run.early_overtriggers},
        {"send_failures", run.early_send_failures},
        {"pacing_late_ns", quantilesOf(run.early_lateness)}}},
  };
  std::ofstream file(path);
  file << json.dump(2) << '\n';
  file.flush();
  if (!file) return std::unexpected("cannot write the statistics " + path);
  return {};
}

}  // namespace emulator
