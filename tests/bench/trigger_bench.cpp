#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "appliance/capture/trigger_loop.h"
#include "appliance/trace/trace_writer.h"
#include "hal/emulated/trigger_line.h"
#include "rt/memory.h"
#include "rt/thread.h"
#include "rt/unique_fd.h"
#include "tests/bench/support/comparison.h"
#include "tests/bench/support/cpus.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

// How late the trigger's edge leaves, beside cyclictest at the same interval, priority and CPU, in
// turns. Both count from the deadline to the instant at which the awake thread looked at the clock;
// ours has drawn nothing yet either.

namespace {

using namespace std::chrono_literals;

constexpr int kPriority = 80;  // of the thread `trigger`
constexpr int kMostCyclictest_us = 20'000;

struct Turn {
  std::chrono::microseconds interval{5000};
  int edges = 800;
  int cpu = 0;
  bool realtime = true;
};

/// The far end of the trigger's wire: takes what comes, on the other CPUs.
class Wire {
 public:
  explicit Wire(int trigger_cpu) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{.sin_family = AF_INET,
                        .sin_port = 0,
                        .sin_addr = {.s_addr = htonl(INADDR_LOOPBACK)},
                        .sin_zero = {}};
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_.get(), generic, size) == 0 &&
        getsockname(socket_.get(), generic, &size) == 0) {
      port_ = ntohs(address.sin_port);
    }
    const timeval wait{.tv_sec = 0, .tv_usec = 100'000};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    drain_ = std::jthread([this, trigger_cpu](const std::stop_token& stop) {
      std::vector<int> cpus = bench::allowedCpus();
      if (cpus.size() > 1) std::erase(cpus, trigger_cpu);
      bench::pinCurrentThread(cpus);
      char datagram[64];
      while (!stop.stop_requested()) (void)recv(socket_.get(), datagram, sizeof datagram, 0);
    });
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  rt::UniqueFd socket_;
  std::uint16_t port_ = 0;
  std::jthread drain_;
};

double toUs(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-3;
}

/// The product's own loop with its trace, for @p turn. Adds to @p late_us and @p done_us.
bool runTriggerLoop(const Turn& turn, std::vector<double>& late_us, std::vector<double>& done_us) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "trace.jsonl";
  Wire wire(turn.cpu);
  auto line = hal::emulated::EmulatedTriggerLine::open(wire.port());
  auto trace = appliance::TraceWriter::open(path);
  if (!line || !trace) {
    std::fprintf(stderr, "trigger: %s\n", (!line ? line.error() : trace.error()).c_str());
    return false;
  }
  appliance::TraceProducer& producer = (*trace)->addProducer("trigger");
  (*trace)->begin({});
  appliance::EdgeBoard edges;
  appliance::GenlockBoard genlock;
  appliance::TriggerLoop loop({.period = turn.interval, .pulse_width = 100us}, **line, edges,
                              genlock, &producer);
  auto thread =
      rt::Thread::start({.name = "trigger",
                         .policy = turn.realtime ? rt::SchedPolicy::kFifo : rt::SchedPolicy::kOther,
                         .priority = turn.realtime ? kPriority : 0,
                         .cpus = {turn.cpu}},
                        [&loop](const std::stop_token& stop) { loop.run(stop); });
  if (!thread) return false;
  std::this_thread::sleep_for(turn.edges * turn.interval);
  thread->requestStop();
  thread->join();
  if (!(*trace)->finish({})) return false;

  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    const auto record = nlohmann::json::parse(text);
    if (record["record"] != "trigger") continue;
    const auto deadline = record["deadline_ns"].get<std::int64_t>();
    late_us.push_back(toUs(record["trigger_edge_before_ns"].get<std::int64_t>() - deadline));
    done_us.push_back(toUs(record["trigger_edge_after_ns"].get<std::int64_t>() - deadline));
  }
  // A deadline that was given up was later than a fifth of the interval; it counts as that late.
  for (std::uint64_t i = 0; i < loop.metrics().missed.value(); ++i) {
    late_us.push_back(toUs(std::chrono::nanoseconds(turn.interval).count()) / 5);
  }
  return true;
}

bool runCyclictest(const Turn& turn, std::vector<double>& late_us) {
  const test::TemporaryFolder folder;
  const std::string json = folder / "cyclictest.json";
  // --default-system: without it cyclictest keeps the processor out of its sleep states for the
  // time of its run, which no daemon does.
  const std::string command =
      "exec cyclictest -q -m -t1 --default-system -a " + std::to_string(turn.cpu) + " -i " +
      std::to_string(turn.interval.count()) + " -l " + std::to_string(turn.edges) + " -h " +
      std::to_string(kMostCyclictest_us) + " --json=" + json +
      (turn.realtime ? " --policy=fifo -p " + std::to_string(kPriority) : " --policy=other");
  test::ChildProcess cyclictest({"/bin/sh", "-c", command}, folder / "log");
  if (cyclictest.wait(60s + std::chrono::duration_cast<std::chrono::seconds>(2 * turn.edges *
                                                                             turn.interval)) != 0)
    return false;
  std::ifstream file(json);
  const auto result = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!result.is_object()) return false;
  const auto& thread = result["thread"]["0"];
  std::size_t counted = 0;
  for (const auto& [us, count] : thread["histogram"].items()) {
    late_us.insert(late_us.end(), count.get<std::size_t>(), std::stod(us));
    counted += count.get<std::size_t>();
  }
  // What the histogram does not reach.
  late_us.insert(late_us.end(), thread["cycles"].get<std::size_t>() - counted,
                 thread["max"].get<double>());
  return true;
}

bool mayRunRealtime() {
  auto probe = rt::Thread::start(
      {.name = "probe", .policy = rt::SchedPolicy::kFifo, .priority = kPriority}, [](auto) {});
  return probe && probe->grant().complete();
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  if (arguments.size() > 1) {
    std::fputs("usage: trigger_bench [--quick] [--rows FILE]\n", stderr);
    return 2;
  }
  (void)rt::lockMemory();
  Turn turn{.realtime = mayRunRealtime()};
  if (!turn.realtime) std::puts("    no real-time priority permitted: both run without");
  int turns = 8;
  if (options.quick) {
    turns = 1;
    turn.edges = 40;
  }
  const std::vector<int> cpus = bench::allowedCpus();
  bench::Samples late{"trigger loop", {}};
  bench::Samples done{"edge has left", {}};
  bench::Samples rival{"cyclictest", {}};
  bool has_rival = true;
  for (int i = 0; i < turns; ++i) {
    turn.cpu = cpus[static_cast<std::size_t>(i / 2) % cpus.size()];
    const auto run_ours = [&] { return runTriggerLoop(turn, late.values, done.values); };
    const auto run_rival = [&] { has_rival = has_rival && runCyclictest(turn, rival.values); };
    if (i % 2 == 1) run_rival();
    if (!run_ours()) return 1;
    if (i % 2 == 0) run_rival();
  }
  if (!has_rival) std::puts("    cyclictest did not run: install rt-tests");
  const bench::Bar bar{bench::Bar::Kind::kRatioAtMost, 1.5};
  return bench::report("trigger",
                       {{.what = "lateness p99",
                         .unit = "us",
                         .ours = late,
                         .rival = rival,
                         .statistic = bench::Statistic::kP99,
                         .bar = bar},
                        {.what = "lateness median", .unit = "us", .ours = late, .rival = rival},
                        {.what = "edge sent, p99",
                         .unit = "us",
                         .ours = done,
                         .statistic = bench::Statistic::kP99}},
                       options)
             ? 0
             : 1;
}
