#include "tests/bench/reception/round.h"

#include <cmath>
#include <cstdio>
#include <thread>

#include <sys/resource.h>

#include "appliance/capture/trigger_loop.h"
#include "appliance/machine/machine_probe.h"
#include "appliance/machine/stall_log.h"
#include "hal/emulated/trigger_line.h"

namespace bench {
namespace {

using namespace std::chrono_literals;

constexpr int kWarmUpTriggers = 12;

std::vector<std::string> emulatorCommand(std::uint32_t cameras, std::uint32_t width_px,
                                         std::uint32_t height_px) {
  return {KAGAMI_EMULATOR, "--cameras", std::to_string(cameras), "--size",
          std::to_string(width_px) + "x" + std::to_string(height_px), "--first-address",
          "127.0.9.1", "--wire-port", std::to_string(EmulatedRig::kWirePort),
          // Hardware is never late for want of a processor.
          "--realtime-priority", "85"};
}

double processCpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Reading {
  rt::Timestamp at = rt::now();
  double cpu_s = processCpu_s();
  std::uint64_t frames = 0;
  std::uint64_t triggers = 0;
};

/// Between two triggers, when the frames of the last one have come.
Reading readBetweenTriggers(const Receiver& receiver, const appliance::EdgeBoard& edges,
                            rt::Nanoseconds period) {
  const auto now = rt::now();
  const auto edge = edges.edge(edges.newest());
  const auto phase = (now - edge) % period;
  rt::sleepUntil(now + (period - phase) + period * 9 / 10);
  return {.frames = receiver.frames(), .triggers = edges.newest()};
}

}  // namespace

EmulatedRig::EmulatedRig(std::uint32_t cameras, std::uint32_t width_px, std::uint32_t height_px)
    : width_px_(width_px),
      height_px_(height_px),
      process_(emulatorCommand(cameras, width_px, height_px), folder_ / "emulator.log"),
      ready_(process_.waitForOutput("ready", 30s)) {}

ReceptionSetup EmulatedRig::setup(std::uint32_t cameras, double rate_hz) const {
  ReceptionSetup setup;
  for (std::uint32_t i = 0; i < cameras; ++i) {
    setup.cameras.push_back({.name = "camera " + std::to_string(i + 1),
                             .address = "127.0.9." + std::to_string(i + 1),
                             .width_px = width_px_,
                             .height_px = height_px_});
  }
  setup.period = rt::Nanoseconds{std::llround(1e9 / rate_hz)};
  setup.receive = {.name = "receive", .policy = rt::SchedPolicy::kFifo, .priority = 70};
  return setup;
}

std::expected<RoundResult, std::string> runRound(const ReceptionSetup& setup,
                                                 const Contestant& contestant,
                                                 std::chrono::milliseconds length) {
  const auto cameras = static_cast<std::uint32_t>(setup.cameras.size());
  const auto board = std::make_unique<appliance::CaptureBoard>(cameras);
  auto line = hal::emulated::EmulatedTriggerLine::open(EmulatedRig::kWirePort);
  if (!line) return std::unexpected(line.error());
  auto receiver = contestant(setup, *board);
  if (!receiver) return std::unexpected(receiver.error());
  appliance::TriggerLoop loop({.period = setup.period, .pulse_width = 100us}, **line, board->edges,
                              board->genlock, /*trace=*/nullptr);
  auto trigger =
      rt::Thread::start({.name = "trigger", .policy = rt::SchedPolicy::kFifo, .priority = 80},
                        [&loop](const std::stop_token& stop) { loop.run(stop); });
  if (!trigger) return std::unexpected("the trigger thread does not start");

  std::this_thread::sleep_for(kWarmUpTriggers * setup.period);
  appliance::MachineProbe probe(setup.period / 5);
  (void)probe.start();  // without the right to it nothing is said of the machine
  const Reading before = readBetweenTriggers(**receiver, board->edges, setup.period);
  std::this_thread::sleep_for(length);
  const Reading after = readBetweenTriggers(**receiver, board->edges, setup.period);
  probe.stop();
  trigger->requestStop();
  trigger->join();
  std::this_thread::sleep_for(2 * setup.period);  // frames on the wire belong to this round

  RoundResult result;
  appliance::StallLog stalls;
  while (const auto stall = probe.tryPop()) stalls.take(*stall);
  result.stalls = stalls.text(rt::now());
  result.cpu_s = after.cpu_s - before.cpu_s;
  result.wall_s = std::chrono::duration<double>(after.at - before.at).count();
  result.frames = after.frames - before.frames;
  result.expected = (after.triggers - before.triggers) * cameras;
  result.bytes = result.frames * setup.frameBytes();
  return result;
}

}  // namespace bench
