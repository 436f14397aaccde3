#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/trigger_loop.h"
#include "appliance/machine/machine_probe.h"
#include "appliance/tools/stall_periods.h"
#include "hal/backends.h"
#include "hal/emulated/trigger_line.h"
#include "tests/bench/reception/round.h"
#include "tests/bench/support/comparison.h"
#include "tests/support/fault_port.h"

// What lost packets cost: twenty cameras at 40 Hz, first on a whole network, then on one that loses
// 1 % of all stream packets, resent ones too. How many frames stay incomplete, and how much later
// the others are complete. Frames that this machine cost are counted apart: the machine's probes
// saw a stall near them, or their edge or the one before left late, so that the cameras sent
// nothing.

namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kCameras = 20;
constexpr double kRate_hz = 40;
constexpr std::uint16_t kFaultPort = 3991;

/// Notes of every frame whether it came whole and how long after its trigger.
class Recorder final : public hal::FrameSink {
 public:
  Recorder(const appliance::EdgeBoard& edges, std::uint32_t first_free, std::uint32_t slots,
           std::size_t triggers)
      : edges_(edges), came_(triggers) {
    for (std::uint32_t slot = first_free; slot < slots; ++slot) free_.push_back(slot);
  }

  std::uint32_t onFrame(const hal::FrameArrival& arrival) noexcept override {
    std::uint64_t trigger = edges_.newest();
    while (trigger > 1 && edges_.edge(trigger) > arrival.first_packet) --trigger;
    const std::scoped_lock lock(mutex_);
    if (trigger < came_.size() && arrival.status != hal::FrameStatus::kAborted) {
      came_[trigger] = {.came = true,
                        .whole = arrival.status == hal::FrameStatus::kComplete,
                        .delay = arrival.last_packet - edges_.edge(trigger)};
    }
    free_.push_back(arrival.slot);
    const std::uint32_t next = free_.front();
    free_.erase(free_.begin());
    return next;
  }

  struct Frame {
    bool came = false;
    bool whole = false;
    rt::Nanoseconds delay{};  ///< from edge to last packet
  };
  /// By trigger. Only when the camera is stopped.
  [[nodiscard]] const std::vector<Frame>& came() const { return came_; }

 private:
  const appliance::EdgeBoard& edges_;
  std::mutex mutex_;
  std::vector<std::uint32_t> free_;
  std::vector<Frame> came_;
};

struct LossRound {
  std::vector<double> delays_ms;  ///< of whole frames
  double incomplete = 0;
  double missing = 0;      ///< no packet of them came
  double stood_still = 0;  ///< incomplete or missing, and this machine may have cost them
  std::size_t stalls = 0;  ///< of the machine
  rt::Nanoseconds longest_stall{0};
};

/// Of every frame of the triggers (@p begin, @p end], whose edges @p edges holds by trigger.
LossRound judge(const std::vector<std::unique_ptr<Recorder>>& recorders,
                const std::vector<rt::Timestamp>& edges, std::uint64_t begin, std::uint64_t end,
                const appliance::StallPeriods& stalls, rt::Nanoseconds period) {
  constexpr rt::Nanoseconds kLate = 2ms;
  LossRound round{.stalls = stalls.count(), .longest_stall = stalls.longest()};
  for (std::uint64_t trigger = begin + 1; trigger <= end; ++trigger) {
    const rt::Nanoseconds spacing = edges[trigger] - edges[trigger - 1];
    const bool late = std::chrono::abs(spacing - period) >= kLate;
    const bool stalled = stalls.mayHaveCost(edges[trigger]);
    for (const auto& recorder : recorders) {
      const Recorder::Frame& frame = recorder->came()[trigger];
      if (frame.whole) {
        round.delays_ms.push_back(static_cast<double>(frame.delay.count()) * 1e-6);
      } else if (stalled || (late && !frame.came)) {
        ++round.stood_still;
      } else {
        ++(frame.came ? round.incomplete : round.missing);
      }
    }
  }
  return round;
}

std::expected<LossRound, std::string> runLossRound(const bench::ReceptionSetup& setup,
                                                   std::chrono::milliseconds length) {
  auto board = std::make_unique<appliance::CaptureBoard>(kCameras);
  auto line = hal::emulated::EmulatedTriggerLine::open(bench::EmulatedRig::kWirePort);
  if (!line) return std::unexpected(line.error());
  const std::uint32_t in_flight = bench::ReceptionSetup::kInFlight;
  const std::uint32_t slots = in_flight + 2;
  std::vector<std::byte> memory(setup.frameBytes() * slots * kCameras);
  std::vector<std::uint32_t> first;
  for (std::uint32_t slot = 0; slot < in_flight; ++slot) first.push_back(slot);
  std::vector<rt::Timestamp> edges(static_cast<std::size_t>(length / setup.period) + 100);

  std::vector<std::unique_ptr<Recorder>> recorders;
  std::vector<std::unique_ptr<hal::Camera>> cameras;
  for (std::uint32_t i = 0; i < kCameras; ++i) {
    std::vector<std::span<std::byte>> spans;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      spans.push_back(
          std::span(memory).subspan(setup.frameBytes() * (i * slots + slot), setup.frameBytes()));
    }
    auto camera = hal::openCamera("aravis", setup.cameras[i], setup.receive);
    if (!camera) return std::unexpected(camera.error());
    recorders.push_back(std::make_unique<Recorder>(board->edges, in_flight, slots, edges.size()));
    cameras.push_back(std::move(*camera));
    if (auto started = cameras.back()->start(*recorders.back(), spans, first); !started) {
      return std::unexpected(started.error());
    }
  }
  appliance::TriggerLoop loop({.period = setup.period, .pulse_width = 100us}, **line, board->edges,
                              board->genlock, /*trace=*/nullptr);
  auto trigger =
      rt::Thread::start({.name = "trigger", .policy = rt::SchedPolicy::kFifo, .priority = 80},
                        [&loop](const std::stop_token& stop) { loop.run(stop); });
  if (!trigger) return std::unexpected("the trigger thread does not start");
  appliance::MachineProbe probe(setup.period / 5);
  if (!probe.start()) std::puts("this machine's stalls are not seen: the probes need CAP_SYS_NICE");
  std::vector<appliance::StallRecord> stalls;
  std::this_thread::sleep_for(20 * setup.period);
  const std::uint64_t begin = board->edges.newest();
  std::uint64_t end = begin;
  const auto keep = [&] {  // the board and the probes' rings keep the last ones only
    while (const auto stall = probe.tryPop()) {
      stalls.push_back({.cpu = stall->cpu, .begin = stall->begin, .end = stall->end});
    }
    for (std::uint64_t i = std::max<std::uint64_t>(end, 1); i <= board->edges.newest(); ++i) {
      if (i < edges.size()) edges[i] = board->edges.edge(i);
    }
    end = std::min<std::uint64_t>(board->edges.newest(), edges.size() - 1);
  };
  for (auto left = length; left > 0ms; left -= 1000ms) {
    keep();
    std::this_thread::sleep_for(std::min(left, 1000ms));
  }
  trigger->requestStop();
  trigger->join();
  keep();
  std::this_thread::sleep_for(4 * setup.period);  // frames on the wire belong to this round
  for (const auto& camera : cameras) camera->stop();
  probe.stop();
  keep();
  return judge(recorders, edges, begin, end, {stalls, setup.period}, setup.period);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  const bench::Options options = bench::takeOptions(arguments);
  if (arguments.size() > 1) {
    std::fputs("usage: loss_bench [--quick] [--rows FILE]\n", stderr);
    return 2;
  }
  const auto length = options.quick ? 2000ms : 60'000ms;
  const bench::EmulatedRig rig(kCameras, options.quick ? 320 : 1280, options.quick ? 256 : 1024);
  if (!rig.ready()) {
    std::fprintf(stderr, "loss: %s\n", rig.error().c_str());
    return 1;
  }
  bench::ReceptionSetup setup = rig.setup(kCameras, kRate_hz);
  for (auto& camera : setup.cameras) camera.packet_delay_ns = 3803;  // two 10 Gb/s uplinks

  const auto fail = [](const std::string& why) {
    std::fprintf(stderr, "loss: %s\n", why.c_str());
    return 1;
  };
  const auto whole = runLossRound(setup, length);
  if (!whole) return fail(whole.error());
  if (test::sendFault(setup.cameras[0].address, kFaultPort, "all loss 1") != "ok")
    return fail("no answer to \"all loss 1\"");
  const auto lossy = runLossRound(setup, length);
  if (!lossy) return fail(lossy.error());

  for (const LossRound* round : {&*whole, &*lossy}) {
    if (round->stalls > 0)
      std::printf("this PC stood still %zu times, %lld ms at most\n", round->stalls,
                  static_cast<long long>(round->longest_stall / 1ms));
  }

  const double later_ms =
      bench::figuresOf(lossy->delays_ms).p99 - bench::figuresOf(whole->delays_ms).p99;
  // Loss explains nothing where frames are missing without it.
  const bool too_busy = whole->incomplete + whole->missing > 0;
  const std::string not_judged = options.quick ? "a quick run"
                                 : too_busy    ? "this machine is too slow or too busy"
                                               : "";
  const bool written = bench::report(
      "loss",
      {{.what = "frames not whole, 1 % loss",
        .unit = "",
        .ours = {.name = "kagami", .values = {lossy->incomplete + lossy->missing}},
        .rival = {.name = "without loss", .values = {whole->incomplete + whole->missing}},
        .bar = bench::Bar{bench::Bar::Kind::kOursAtMost, 0},
        .not_judged = not_judged},
       {.what = "not whole: this machine stood still",
        .unit = "",
        .ours = {.name = "kagami", .values = {lossy->stood_still}},
        .rival = {.name = "without loss", .values = {whole->stood_still}}},
       {.what = "trigger to last packet, 1 % loss",
        .unit = "ms",
        .ours = {.name = "kagami", .values = lossy->delays_ms},
        .rival = {.name = "without loss", .values = whole->delays_ms},
        .statistic = bench::Statistic::kP99},
       {.what = "its p99 later than without loss",
        .unit = "ms",
        .ours = {.name = "kagami", .values = {later_ms}},
        .bar = bench::Bar{bench::Bar::Kind::kOursAtMost, 25},
        .not_judged = not_judged}},
      options);
  return written ? 0 : 1;
}
