#include "ui-kms/frame_pacer.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ui {
namespace {

// How fast the period may wander, as variance per vblank in units of the stamps' variance: sets
// the memory, sqrt(2 * sqrt(kWander)) = 1.4 % of a stamp's error goes into the instant.
constexpr double kWander = 1e-8;
constexpr double kPeriodUnsure = 0.01;    // of the mode's refresh rate, relative
constexpr double kFirstJitter_ns = 50e3;  // until stamps are known
constexpr double kLeastJitter_ns = 2e3;
constexpr double kJitterMemory = 64;      // stamps
constexpr double kFirstJitterWeight = 4;  // stamps
constexpr double kMostSigmas = 3;
constexpr double kMostOffNominal = 0.05;  // relative: no screen is, so the stamps were nonsense
constexpr double kFarOff = 0.125;         // periods
constexpr int kFarOffInARow = 8;          // once known; before, two that disagree are enough

}  // namespace

FramePacer::FramePacer(double refresh_hz, rt::Nanoseconds commit_margin)
    : commit_margin_(commit_margin), nominal_ns_(1e9 / refresh_hz) {
  assert(refresh_hz > 0);
}

void FramePacer::restart(double refresh_hz) RT_SAFE {
  assert(refresh_hz > 0);
  nominal_ns_ = 1e9 / refresh_hz;
  seen_ = 0;
}

void FramePacer::onVblank(std::uint64_t vblank, rt::Timestamp stamp) RT_SAFE {
  if (vblank < vblank_) seen_ = 0;
  if (seen_ == 0) {
    vblank_ = vblank;
    seen_ = 1;  // not trusted
    return;
  }
  if (vblank == vblank_) return;
  if (seen_ == 1) return begin(vblank, stamp);
  const auto vblanks = static_cast<double>(vblank - vblank_);
  predict(vblanks);
  vblank_ = vblank;
  const auto innovation_ns = static_cast<double>((stamp - at_).count());
  if (std::abs(innovation_ns) < kFarOff * period_ns_) {
    far_off_ = 0;
  } else {
    const bool same_side = (innovation_ns < 0) == (far_off_ < 0);
    far_off_ = (same_side ? far_off_ : 0) + (innovation_ns < 0 ? -1 : 1);
  }
  const int enough = seen_ < kKnownAfter ? 1 : kFarOffInARow;
  if (std::abs(far_off_) >= enough) return begin(vblank, stamp);
  correct(innovation_ns);
  if (std::abs(period_ns_ / nominal_ns_ - 1) > kMostOffNominal) return begin(vblank, stamp);
  ++seen_;
}

void FramePacer::begin(std::uint64_t vblank, rt::Timestamp stamp) RT_SAFE {
  vblank_ = vblank;
  at_ = stamp;
  period_ns_ = nominal_ns_;
  jitter_ns2_ = kFirstJitter_ns * kFirstJitter_ns;
  const double unsure = kPeriodUnsure * nominal_ns_ / kFirstJitter_ns;
  instant_ = 1;
  both_ = 0;
  period_ = unsure * unsure;
  far_off_ = 0;
  seen_ = 2;
}

/// The instant follows the period, which itself wanders: variances grow with the distance.
void FramePacer::predict(double vblanks) RT_SAFE {
  at_ += rt::Nanoseconds(std::llround(vblanks * period_ns_));
  instant_ += vblanks * (2 * both_ + vblanks * (period_ + vblanks * kWander / 3));
  both_ += vblanks * (period_ + vblanks * kWander / 2);
  period_ += vblanks * kWander;
}

void FramePacer::correct(double innovation_ns) RT_SAFE {
  const double expected = instant_ + 1;  // variance of the innovation
  const double most_ns = kMostSigmas * std::sqrt(expected * jitter_ns2_);
  const double taken_ns = std::clamp(innovation_ns, -most_ns, most_ns);

  const double to_instant = instant_ / expected;
  const double to_period = both_ / expected;
  at_ += rt::Nanoseconds(std::llround(to_instant * taken_ns));
  period_ns_ += to_period * taken_ns;
  period_ -= to_period * both_;
  both_ -= to_instant * both_;
  instant_ -= to_instant * instant_;

  const double memory = std::min(kFirstJitterWeight + seen_, kJitterMemory);
  jitter_ns2_ += (taken_ns * taken_ns / expected - jitter_ns2_) / memory;
  jitter_ns2_ = std::max(jitter_ns2_, kLeastJitter_ns * kLeastJitter_ns);
}

void FramePacer::onPicture(const hal::RenderInstants& instants) RT_SAFE {
  draw_.add(instants.warp_end - instants.warp_submit);
}

std::optional<hal::DisplayTiming> FramePacer::timing() const RT_SAFE {
  if (seen_ < kKnownAfter) return std::nullopt;
  return hal::DisplayTiming{.vblank = vblank_,
                            .at = at_,
                            .period_ns = period_ns_,
                            .stamp_jitter_ns = std::sqrt(jitter_ns2_),
                            .draw = draw_.high(),
                            .commit_margin = commit_margin_};
}

}  // namespace ui
