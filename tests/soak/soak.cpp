// kagami-soak: the real programs for hours, one fault after the other, every lost frame explained.
// docs/soak.md is its page; ./dev soak runs it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "appliance/tools/stall_periods.h"
#include "appliance/trace/trace_file.h"
#include "tests/soak/box.h"
#include "tests/soak/judgement.h"
#include "tests/soak/line_stream.h"
#include "tests/soak/memory_growth.h"

namespace soak {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kTick = 50ms;
constexpr rt::Nanoseconds kStatusEvery = 250ms;
constexpr rt::Nanoseconds kHoldingEvery = 1s;
constexpr rt::Nanoseconds kProgressEvery = 10s;
constexpr rt::Nanoseconds kLastRecovery = 4s;  // after the last fault, before the end
constexpr rt::Nanoseconds kStatusLag = 1s;  // a camera that came back may still be reported as lost
constexpr std::int64_t kMostGrowth_bytes = 1 << 20;
constexpr std::size_t kMostLines = 20;  // of one sort on the terminal; the file has all

std::atomic<bool> stop_asked{false};

struct Options {
  double hours = 0;
  double fault_every_s = 10;
  std::span<const FaultKind> faults = faultKinds();
  BoxOptions box{.folder = "out/soak"};
};

/// What both files of the running programs have said so far.
///
/// Threads  The streams' threads write, main reads: under the lock.
struct Records {
  Records(std::uint32_t cameras, rt::Nanoseconds period) : account(cameras, period) {}
  std::mutex mutex;
  LossAccount account;
  std::vector<appliance::StallRecord> stalls;  // when this machine stood still
  std::optional<appliance::SummaryRecord> summary;
  std::string unreadable;  // the first line that could not be read
};

void takeTraceLine(Records& records, std::string_view line) {
  const auto record = appliance::parseTraceLine(line);
  const std::scoped_lock lock(records.mutex);
  if (!record) {
    if (records.unreadable.empty()) records.unreadable = "trace: " + record.error();
  } else if (const auto* trigger = std::get_if<appliance::TriggerRecord>(&*record)) {
    records.account.triggerFired(*trigger);
  } else if (const auto* frame = std::get_if<appliance::FrameRecord>(&*record)) {
    records.account.frameArrived(*frame);
  } else if (const auto* stall = std::get_if<appliance::StallRecord>(&*record)) {
    records.stalls.push_back(*stall);
  } else if (const auto* summary = std::get_if<appliance::SummaryRecord>(&*record)) {
    records.summary = *summary;
  }
}

void takeWireLine(Records& records, std::string_view line) {
  if (line == appliance::kWireLogHeader) return;
  const auto frame = appliance::parseWireLine(line);
  const std::scoped_lock lock(records.mutex);
  if (frame) {
    records.account.frameSent(*frame);
  } else if (records.unreadable.empty()) {
    records.unreadable = "wire log: not a line of it";
  }
}

/// One run, from the running box to the verdict.
class Run {
 public:
  Run(const Options& options, Box& box, Records& records)
      : options_(options),
        box_(box),
        records_(records),
        period_(options.box.period()),
        every_(std::llround(options.fault_every_s * 1e9)),
        plan_(options.faults, options.box.cameras, every_, options.box.seed) {}

  void watch();
  /// Everything that makes the run bad, a line each; writes and prints the tables.
  [[nodiscard]] std::vector<std::string> conclude();

  /// Something that makes the run bad; the same words count once.
  void note(const std::string& problem) {
    if (std::ranges::find(problems_, problem) == problems_.end()) problems_.push_back(problem);
  }

  rt::Timestamp stop_asked_at;  ///< of the daemon: later triggers are not judged

 private:
  void beginFault(rt::Timestamp now);
  void endFault(rt::Timestamp now);
  void lookAtStatus(rt::Timestamp now);
  void tellProgress(rt::Timestamp now);
  [[nodiscard]] bool mayBeSilent(std::uint32_t camera, rt::Timestamp now) const;
  [[nodiscard]] Judgement judgedSoFar();
  void noteWhatIsBad(const Judgement& judgement);
  void noteGrowth(const Growth& growth);

  const Options& options_;
  Box& box_;
  Records& records_;
  rt::Nanoseconds period_;
  rt::Nanoseconds every_;
  FaultPlan plan_;
  rt::Timestamp start_ = rt::now();
  rt::Timestamp end_;
  std::vector<Fault> faults_;
  bool undone_ = true;  // the last fault
  rt::Nanoseconds lasts_{};
  std::vector<std::string> problems_;
  std::vector<Holding> held_;
  rt::Timestamp warm_up_end_ = rt::Timestamp::max();  // not yet
  std::set<std::uint32_t> reported_silent_;  // cameras already named as silent for no reason
};

void Run::watch() {
  end_ = start_ + rt::Nanoseconds(std::llround(options_.hours * 3600e9));
  rt::Timestamp next_fault = start_ + every_;
  rt::Timestamp next_status = start_;
  rt::Timestamp next_holding = start_;
  rt::Timestamp next_progress = start_ + kProgressEvery;
  while (!stop_asked && rt::now() < end_) {
    std::this_thread::sleep_for(kTick);
    const rt::Timestamp now = rt::now();
    if (const std::string ended = box_.ended(); !ended.empty()) {
      note(ended);
      return;
    }
    if (!undone_ && now >= faults_.back().from + lasts_) endFault(now);
    if (undone_ && now >= next_fault && now + every_ < end_) {
      beginFault(now);
      next_fault += every_;
    }
    if (now >= next_status) {
      lookAtStatus(now);
      next_status = now + kStatusEvery;
    }
    if (now >= next_holding) {
      if (const auto holding = look(box_.daemonPid())) held_.push_back(*holding);
      next_holding = now + kHoldingEvery;
    }
    if (now >= next_progress) {
      tellProgress(now);
      next_progress += kProgressEvery;
    }
  }
  if (undone_) return;
  endFault(rt::now());
  std::this_thread::sleep_for(kLastRecovery);  // the last fault's recovery is judged, too
}

void Run::beginFault(rt::Timestamp now) {
  const PlannedFault planned = plan_.next();
  faults_.push_back(
      {.kind = planned.kind,
       .camera = planned.camera,
       .from = now,
       .until = planned.kind->end.empty() ? now + planned.lasts : rt::Timestamp::max()});
  undone_ = planned.kind->end.empty();
  lasts_ = planned.lasts;
  if (const auto done = box_.fault(planned.camera, planned.kind->begin); !done) note(done.error());
  // Every kind has been there once: what recovery needs, once, is allocated.
  if (faults_.size() == options_.faults.size() + 1) warm_up_end_ = now;
}

void Run::endFault(rt::Timestamp now) {
  Fault& fault = faults_.back();
  if (const auto done = box_.fault(fault.camera, fault.kind->end); !done) note(done.error());
  fault.until = now;
  undone_ = true;
}

bool Run::mayBeSilent(std::uint32_t camera, rt::Timestamp now) const {
  for (auto fault = faults_.rbegin(); fault != faults_.rend(); ++fault) {
    if (fault->camera != camera) continue;
    return fault->until == rt::Timestamp::max() ||
           now <= fault->until + fault->kind->recovery + kStatusLag;
  }
  return false;
}

void Run::lookAtStatus(rt::Timestamp now) {
  const auto text = box_.status();
  if (!text) {
    note("no status: " + text.error());
    return;
  }
  const auto status = nlohmann::json::parse(*text, nullptr, false);
  if (!status.is_object() || !status.contains("cameras")) {
    note("the status is not JSON");
    return;
  }
  std::uint32_t camera = 0;
  for (const auto& one : status["cameras"]) {
    const std::string state = one.value("state", "");
    const std::uint32_t i = camera++;
    if (state == "streaming" || state == "degraded") {
      reported_silent_.erase(i);
      continue;
    }
    if (!faults_.empty() && faults_.back().camera == i && mayBeSilent(i, now))
      faults_.back().named = true;
    if (mayBeSilent(i, now) || now < start_ + LossAccount::kSettling) continue;
    if (reported_silent_.insert(i).second)
      note("camera " + std::to_string(i + 1) + " was " + state + " without a fault on it");
  }
}

Judgement Run::judgedSoFar() {
  const std::scoped_lock lock(records_.mutex);
  return judge(records_.account.lost(), faults_, records_.stalls, period_);
}

void Run::tellProgress(rt::Timestamp now) {
  const Judgement judgement = judgedSoFar();
  std::uint64_t explained = 0;
  for (const FaultOutcome& one : judgement.faults) explained += one.lostFrames();
  const auto left = std::chrono::ceil<std::chrono::seconds>(end_ - now).count();
  std::printf(
      "soak: %lld:%02lld:%02lld left; %zu faults, %llu lost frames explained, %zu not; "
      "kagamid holds %.1f MiB\n",
      static_cast<long long>(left / 3600), static_cast<long long>(left / 60 % 60),
      static_cast<long long>(left % 60), faults_.size(), static_cast<unsigned long long>(explained),
      judgement.unexplained.size(),
      held_.empty() ? 0 : static_cast<double>(held_.back().resident_bytes) / 1048576.0);
  (void)std::fflush(stdout);
}

std::vector<std::string> Run::conclude() {
  {
    const std::scoped_lock lock(records_.mutex);
    records_.account.finish(stop_asked_at - LossAccount::kLongestWay);
  }
  const Judgement judgement = judgedSoFar();
  const std::optional<Growth> growth = growthOf(held_, warm_up_end_);
  noteWhatIsBad(judgement);
  if (growth) noteGrowth(*growth);

  const std::filesystem::path path = options_.box.folder / "soak.txt";
  std::ofstream table(path);
  table << faultTable(judgement, start_) << "\n" << kindTable(judgement);
  for (const std::string& line : problems_) table << "NOT GOOD: " << line << "\n";
  std::printf("\n%s\n", kindTable(judgement).c_str());
  const LossAccount& account = records_.account;
  std::printf(
      "%llu triggers judged, %llu frames stored, %zu lost, %zu of them unexplained; %llu lost in "
      "the first %lld s, not judged\n",
      static_cast<unsigned long long>(account.triggersJudged()),
      static_cast<unsigned long long>(account.framesStored()), account.lost().size(),
      judgement.unexplained.size(), static_cast<unsigned long long>(account.lostWhileSettling()),
      static_cast<long long>(LossAccount::kSettling / 1s));
  const appliance::StallPeriods stalls(records_.stalls, period_);
  if (stalls.count() > 0)
    std::printf("this PC stood still %zu times, for %lld ms at most (firmware or host)\n",
                stalls.count(), static_cast<long long>(stalls.longest() / 1ms));
  if (!judgement.stood_still.empty())
    std::printf("%zu frames lost because this PC stood still: counted apart, not judged\n",
                judgement.stood_still.size());
  if (!growth)
    std::printf("memory is not judged: that takes every fault once (%zu x %g s) and %lld s more\n",
                options_.faults.size() + 1, options_.fault_every_s,
                static_cast<long long>(2 * kSpan / 1s));
  std::printf("every fault: %s\n", path.c_str());
  return problems_;
}

void Run::noteWhatIsBad(const Judgement& judgement) {
  if (!records_.unreadable.empty()) note(records_.unreadable);
  if (!records_.summary) {
    note("kagamid did not shut down cleanly: its trace has no summary");
  } else if (records_.summary->trace_dropped > 0) {
    note("the trace lost " + std::to_string(records_.summary->trace_dropped) + " records");
  }
  if (records_.account.triggersJudged() == 0) note("no trigger was judged: run longer");
  for (const LostFrame& lost : judgement.unexplained)
    problems_.push_back("unexplained: " + describe(lost, start_));
  for (const MisattributedFrame& frame : records_.account.misattributed())
    problems_.push_back("camera " + std::to_string(frame.camera + 1) +
                        ": the frame stored as that of trigger " + std::to_string(frame.trigger) +
                        " was sent for another one");
  for (const FaultOutcome& one : judgement.faults) {
    const bool just_begun = one.fault.from + kStatusLag > stop_asked_at;
    if (one.fault.kind->named && !one.fault.named && !just_begun)
      problems_.push_back("camera " + std::to_string(one.fault.camera + 1) + " (" +
                          std::string(one.fault.kind->name) + ") was never reported as silent");
  }
}

void Run::noteGrowth(const Growth& growth) {
  const auto grown_kib = static_cast<long long>(growth.resident_bytes / 1024);
  const auto more_files = static_cast<long long>(growth.open_files);
  std::printf("kagamid's memory %+lld KiB, open files %+lld since every fault was there once\n",
              grown_kib, more_files);
  if (growth.resident_bytes > kMostGrowth_bytes)
    note("kagamid's memory grew by " + std::to_string(grown_kib) + " KiB after the warm-up");
  if (more_files > 0)
    note("kagamid has " + std::to_string(more_files) + " more open files than after the warm-up");
}

/// Errors   One line; the box did not start.
std::expected<std::vector<std::string>, std::string> soak(const Options& options) {
  Records records(options.box.cameras, options.box.period());
  LineStream trace(Box::tracePath(options.box.folder),
                   [&](std::string_view line) { takeTraceLine(records, line); });
  LineStream wire(Box::wirePath(options.box.folder),
                  [&](std::string_view line) { takeWireLine(records, line); });
  if (!trace.open() || !wire.open())
    return std::unexpected(options.box.folder.string() + ": no pipe can be made there");
  auto box = Box::start(options.box);
  if (!box) return std::unexpected(box.error());
  Run run(options, **box, records);
  run.watch();
  std::printf("soak: %s\n", stop_asked ? "stopped: judging what was seen" : "judging");
  run.stop_asked_at = rt::now();
  if (const auto stopped = (*box)->stopDaemon(); !stopped) run.note(stopped.error());
  trace.join();
  if (const auto stopped = (*box)->stopEmulator(); !stopped) run.note(stopped.error());
  wire.join();
  return run.conclude();
}

int main(int argc, char** argv) {
  Options options;
  options.box.programs = std::filesystem::canonical("/proc/self/exe").parent_path();
  CLI::App app{"kagami-soak: the whole box for hours, one fault after the other"};
  app.add_option("--hours", options.hours, "length of the run")
      ->required()
      ->check(CLI::Range(0.001, 1000.0));
  app.add_option("--fault-every", options.fault_every_s, "seconds from one fault to the next")
      ->check(CLI::Range(4.0, 3600.0))
      ->capture_default_str();
  std::string only;
  app.add_option("--only", only, "the one kind of fault, for instance \"cable pulled\"");
  app.add_option("--cameras", options.box.cameras)->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--size", options.box.size, "of their pictures, in pixels")->capture_default_str();
  app.add_option("--fps", options.box.rate_hz, "trigger rate")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  app.add_option("--out", options.box.folder, "where table and logs go")->capture_default_str();
  app.add_option("--seed", options.box.seed, "of the faults")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!only.empty()) {
    const FaultKind* kind = findFaultKind(only);
    if (kind == nullptr) {
      std::fprintf(stderr, "soak: no fault is called \"%s\"; there are:", only.c_str());
      for (const FaultKind& one : faultKinds())
        std::fprintf(stderr, " \"%s\"", std::string(one.name).c_str());
      std::fprintf(stderr, "\n");
      return 2;
    }
    options.faults = {kind, 1};
  }

  struct sigaction ask{};
  ask.sa_handler = [](int) { stop_asked = true; };
  (void)sigaction(SIGINT, &ask, nullptr);
  (void)sigaction(SIGTERM, &ask, nullptr);

  std::error_code failed;
  std::filesystem::create_directories(options.box.folder, failed);
  options.box.folder = std::filesystem::absolute(options.box.folder);
  const auto bad = soak(options);
  if (!bad) {
    std::fprintf(stderr, "soak: %s\n", bad.error().c_str());
    return 2;
  }
  for (std::size_t i = 0; i < std::min(bad->size(), kMostLines); ++i)
    std::printf("soak: NOT GOOD: %s\n", (*bad)[i].c_str());
  if (bad->size() > kMostLines) std::printf("soak: and %zu more\n", bad->size() - kMostLines);
  std::printf("soak: %s\n", bad->empty() ? "GOOD: every lost frame is explained" : "NOT GOOD");
  return bad->empty() ? 0 : 1;
}

}  // namespace
}  // namespace soak

int main(int argc, char** argv) {
  return soak::main(argc, argv);
}
