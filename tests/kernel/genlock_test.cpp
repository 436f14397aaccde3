// The product's own trigger loop, pacer and screen on true page flips. In virtual time only
// our own logic can be late.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/genlock_board.h"
#include "appliance/capture/trigger_loop.h"
#include "hal/trigger_line.h"
#include "rt/doorbell.h"
#include "rt/high_quantile.h"
#include "rt/periodic_loop.h"
#include "rt/spsc_ring.h"
#include "rt/thread.h"
#include "tests/kernel/support/kms_viewer.h"

namespace test {
namespace {

using appliance::GenlockState;
using namespace std::chrono_literals;

constexpr double kSeconds = 8;
constexpr rt::Nanoseconds kMargin = 1500us;

struct Fired {
  std::uint64_t trigger = 0;
  rt::Timestamp edge;
  appliance::GenlockStatus status;
};

/// A line with a camera at its end whose instants of firing are known.
class CameraLine final : public hal::TriggerLine {
 public:
  explicit CameraLine(const appliance::GenlockBoard& genlock) : genlock_(genlock) {}

  rt::Result<hal::TriggerEdge> setActive(bool active) RT_SAFE override {
    const rt::Timestamp now = rt::now();
    if (active) {
      (void)fired_.tryPush({++trigger_, now, genlock_.status.load()});
      bell_.ring();
    }
    return hal::TriggerEdge{now, now};
  }

  std::optional<Fired> wait() {
    (void)bell_.waitUntil(rt::now() + 100ms);
    return fired_.tryPop();
  }

 private:
  const appliance::GenlockBoard& genlock_;
  std::uint64_t trigger_ = 0;
  rt::SpscRing<Fired, 64> fired_;
  rt::Doorbell bell_;
};

struct LockRun {
  std::vector<Fired> fired;
  std::map<std::uint64_t, hal::PageFlip> flips;  // by trigger
  appliance::GenlockStatus last;
  double vblank_ns = 0;
};

/// Triggers of @p trigger_hz, each frame ready 10 ms later and shown immediately.
LockRun runAt(double trigger_hz, rt::Nanoseconds start_phase) {
  ui::KmsConfig config = KmsViewer::quick("/dev/dri/card0");
  config.path = ui::ScanoutPath::kCopied;  // in place every picture costs many page faults here
  KmsViewer viewer(config);
  if (!viewer) return {};
  hal::Display& display = viewer.display();
  // The first picture lights the screen; from then on its vblanks go their own way.
  if (!viewer.show()) {
    ADD_FAILURE() << "no picture came on screen";
    return {};
  }
  std::this_thread::sleep_for(start_phase);

  appliance::EdgeBoard edges;
  appliance::GenlockBoard genlock;
  CameraLine line(genlock);
  const rt::Nanoseconds period(std::llround(1e9 / trigger_hz));
  appliance::TriggerLoop loop(
      {.period = period, .pulse_width = 100us, .genlock = true, .genlock_margin = kMargin}, line,
      edges, genlock, nullptr);
  // As the product does: the timers of other threads may be 50 us late.
  auto trigger = rt::Thread::start(
      {.name = "trigger", .policy = rt::SchedPolicy::kFifo, .priority = 80, .cpus = {}},
      [&](const std::stop_token& stop) { loop.run(stop); });
  if (!trigger) {
    ADD_FAILURE() << trigger.error().where;
    return {};
  }

  LockRun run;
  rt::HighQuantile ready;
  const auto noteFlips = [&] {
    while (const auto flip = display.tryPopFlip()) run.flips[flip->picture_id] = *flip;
  };
  const auto triggers = static_cast<std::size_t>(kSeconds * trigger_hz);
  for (int silent = 0; run.fired.size() < triggers && silent < 50;) {
    const auto fired = line.wait();
    if (!fired) {
      ++silent;
      continue;
    }
    run.fired.push_back(*fired);
    // A frame takes 10 ms, now and then a little longer.
    rt::sleepUntil(fired->edge + 10ms + (fired->trigger % 7) * 50us);
    ready.add(rt::now() - fired->edge);
    noteFlips();
    if (display.render({})) (void)display.commit(fired->trigger);
    genlock.input.publish({.timing = display.timing(), .ready_delay = ready.high()});
  }
  *trigger = {};
  std::this_thread::sleep_for(100ms);
  noteFlips();
  run.last = genlock.status.load();
  if (const auto timing = display.timing()) run.vblank_ns = timing->period_ns;
  display.detach();
  return run;
}

void expectLocked(double trigger_hz, rt::Nanoseconds start_phase, std::int64_t vblanks) {
  const LockRun run = runAt(trigger_hz, start_phase);
  ASSERT_FALSE(run.fired.empty());
  ASSERT_EQ(run.last.state, GenlockState::kLocked);
  EXPECT_EQ(run.last.vblanks_per_trigger, vblanks);
  EXPECT_EQ(run.last.unlocks, 0U);

  const hal::PageFlip* before = nullptr;
  double lock_s = -1;
  double worst_us = 0;
  double locked_ms = 0;
  int locked = 0;
  for (const Fired& fired : run.fired) {
    if (fired.status.state != GenlockState::kLocked) continue;
    if (lock_s < 0)
      lock_s = std::chrono::duration<double>(fired.edge - run.fired.front().edge).count();
    const auto flip = run.flips.find(fired.trigger);
    ASSERT_NE(flip, run.flips.end()) << "trigger " << fired.trigger << " was not shown";
    if (before != nullptr) {
      EXPECT_EQ(static_cast<std::int64_t>(flip->second.vblank - before->vblank), vblanks)
          << "trigger " << fired.trigger;
    }
    before = &flip->second;
    const rt::Nanoseconds off = flip->second.page_flip - (fired.edge + fired.status.lead);
    worst_us = std::max(worst_us, std::abs(static_cast<double>(off.count())) / 1e3);
    locked_ms += static_cast<double>((flip->second.page_flip - fired.edge).count()) / 1e6;
    ++locked;
  }
  std::printf(
      "%.6g Hz triggers: lock in %.2f s, phase within %.1f us, trigger to flip %.3f ms over %d\n",
      trigger_hz, lock_s, worst_us, locked_ms / locked, locked);
  EXPECT_GE(lock_s, 0);
  EXPECT_LE(lock_s, 2);
  EXPECT_LE(worst_us, 5);  // stamps and VKMS's timer are whole microseconds
  EXPECT_LE(locked_ms / locked, 10.3 + 1.5 + run.vblank_ns / 1e6);
}

TEST(GenlockOnVkms, LocksOneTriggerToEveryVblankFromAnyPhase) {
  for (const auto phase : {0us, 5100us, 11300us}) expectLocked(60, phase, 1);
}

TEST(GenlockOnVkms, LocksOneTriggerToEverySecondAndThirdVblank) {
  expectLocked(30, 3ms, 2);
  expectLocked(20, 7ms, 3);
}

TEST(GenlockOnVkms, LeavesTriggersAloneThatFitNoVblanks) {
  const LockRun run = runAt(40, 0us);
  EXPECT_EQ(run.last.state, GenlockState::kFreeRunning);
  EXPECT_EQ(run.last.reason, appliance::GenlockReason::kRatio);
  for (std::size_t i = 1; i < run.fired.size(); ++i)
    ASSERT_NEAR(static_cast<double>((run.fired[i].edge - run.fired[i - 1].edge).count()), 25e6, 1e3)
        << "virtual time is exact";
}

}  // namespace
}  // namespace test
