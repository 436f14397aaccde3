#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "appliance/capture/genlock.h"
#include "hal/display.h"
#include "rt/high_quantile.h"
#include "rt/periodic_loop.h"
#include "tests/support/simulated_screen.h"
#include "ui-kms/frame_pacer.h"

/// Trigger loop, cameras, renderer and screen in invented time: what is ours is the product's own
/// pacer, genlock and schedule, all else is made of random delays.
struct GenlockWorld {
  SimulatedScreen::Crystal crystal;
  double stamp_jitter_ns = 50e3;
  double mode_hz = 0;  ///< what the mode says; 0: the crystal's nominal rate
  rt::Nanoseconds commit_margin = std::chrono::microseconds(300);

  double trigger_hz = 60;
  bool genlock = true;
  rt::Nanoseconds margin = std::chrono::microseconds(1500);
  rt::Nanoseconds phase{};  ///< of the first trigger against the first vblank

  rt::Nanoseconds exposure = std::chrono::milliseconds(1);
  rt::Nanoseconds transfer = std::chrono::microseconds(10500);
  rt::Nanoseconds ready_spread = std::chrono::microseconds(300);  ///< uniform, on top
  rt::Nanoseconds draw = std::chrono::milliseconds(4);
  rt::Nanoseconds draw_spread = std::chrono::microseconds(500);

  double lost_share = 0;        ///< of the flip events
  double silence_begin_s = -1;  ///< and all of them from here
  double silence_seconds = 0;   ///< for so long
  double off_share = 0;         ///< stamps that are milliseconds off
  std::uint32_t seed = 1;
  std::uint64_t first_vblank_told = 0;  ///< numbers do not begin at 0
};

/// One trigger and what became of it.
struct SimulatedTrigger {
  rt::Timestamp deadline;
  std::uint64_t vblank = 0;         ///< with which it came on screen
  rt::Timestamp flip;               ///< truly
  double phase_error_us = 0;        ///< against the true vblanks; of a locked trigger
  appliance::GenlockStatus status;  ///< when it was fired
};

class GenlockSimulation {
 public:
  explicit GenlockSimulation(const GenlockWorld& world)
      : world_(world),
        period_(std::llround(1e9 / world.trigger_hz)),
        screen_(world.crystal, world.stamp_jitter_ns, kStart, world.seed),
        pacer_(world.mode_hz > 0 ? world.mode_hz : world.crystal.nominal_hz, world.commit_margin),
        genlock_({.enabled = world.genlock, .period = period_, .margin = world.margin}),
        schedule_(kStart + std::chrono::milliseconds(100) + world.phase, period_, period_ / 5),
        random_(world.seed + 1000) {}

  /// The triggers of the next @p seconds.
  std::vector<SimulatedTrigger> run(double seconds) {
    std::vector<SimulatedTrigger> fired;
    const rt::Timestamp end = schedule_.deadline() + rt::Nanoseconds(std::llround(seconds * 1e9));
    while (schedule_.deadline() < end) {
      const auto tick =
          schedule_.wake(schedule_.deadline() + someOf(std::chrono::microseconds(60)));
      fired.push_back(fire(tick->deadline));
      hearFlips(tick->deadline);
      genlock_.take({.timing = pacer_.timing(), .ready_delay = ready_.high()});
      schedule_.nudge(genlock_.step(schedule_.deadline()));
    }
    return fired;
  }

  [[nodiscard]] const appliance::GenlockStatus& status() const { return genlock_.status(); }
  [[nodiscard]] rt::Nanoseconds vblankPeriod() const {
    return rt::Nanoseconds(std::llround(1e9 / world_.crystal.nominal_hz));
  }
  /// Exposure, transfer and margin.
  [[nodiscard]] rt::Nanoseconds fixedPart() const {
    return world_.exposure + world_.transfer + world_.ready_spread / 2 + world_.margin;
  }
  [[nodiscard]] static double seconds(rt::Timestamp t) {
    return static_cast<double>((t - kStart).count()) * 1e-9;
  }
  static constexpr rt::Timestamp kStart = rt::fromNs(3'600'000'000'000);

 private:
  rt::Nanoseconds someOf(rt::Nanoseconds most) {
    return rt::Nanoseconds(std::uniform_int_distribution<std::int64_t>(0, most.count())(random_));
  }
  bool chance(double share) { return std::bernoulli_distribution(share)(random_); }

  SimulatedTrigger fire(rt::Timestamp deadline) {
    const rt::Timestamp edge = deadline + someOf(std::chrono::microseconds(20));
    const rt::Timestamp ready =
        edge + world_.exposure + world_.transfer + someOf(world_.ready_spread);
    const rt::Timestamp begin =
        std::max(ready + someOf(std::chrono::microseconds(100)), renderer_free_);
    const rt::Timestamp commit = begin + world_.draw + someOf(world_.draw_spread);
    ready_.add(ready - edge);
    pacer_.onPicture({.warp_submit = begin, .upload_end = begin, .warp_end = commit});
    renderer_free_ = commit;
    // A screen whose last commit has not flipped yet is busy: the picture is skipped.
    const bool busy = commit < screen_.truly(last_vblank_);
    const std::uint64_t vblank = busy ? 0 : screen_.firstAfter(commit + world_.commit_margin);
    if (!busy) flips_.push_back(last_vblank_ = vblank);

    SimulatedTrigger trigger{.deadline = deadline,
                             .vblank = vblank,
                             .flip = busy ? rt::Timestamp{} : screen_.truly(vblank),
                             .status = genlock_.status()};
    const rt::Timestamp meant = deadline + trigger.status.lead;
    const std::uint64_t nearest = screen_.firstAfter(meant - vblankPeriod() / 2);
    trigger.phase_error_us = static_cast<double>((meant - screen_.truly(nearest)).count()) / 1e3;
    return trigger;
  }

  void hearFlips(rt::Timestamp now) {
    while (!flips_.empty() && screen_.truly(flips_.front()) < now) {
      const std::uint64_t vblank = flips_.front();
      flips_.pop_front();
      const double t_s = seconds(screen_.truly(vblank));
      const bool silent = t_s >= world_.silence_begin_s && world_.silence_begin_s >= 0 &&
                          t_s < world_.silence_begin_s + world_.silence_seconds;
      if (silent || chance(world_.lost_share)) continue;
      rt::Timestamp stamp = screen_.flip(1, vblank).page_flip;
      if (chance(world_.off_share)) stamp += someOf(std::chrono::milliseconds(10));
      pacer_.onVblank(vblank + world_.first_vblank_told, stamp);
    }
  }

  GenlockWorld world_;
  rt::Nanoseconds period_;
  SimulatedScreen screen_;
  ui::FramePacer pacer_;
  rt::HighQuantile ready_;
  appliance::Genlock genlock_;
  rt::PeriodicSchedule schedule_;
  std::mt19937 random_;
  std::deque<std::uint64_t> flips_;
  std::uint64_t last_vblank_ = 0;
  rt::Timestamp renderer_free_;
};
