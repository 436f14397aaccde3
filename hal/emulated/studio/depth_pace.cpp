#include "hal/emulated/studio/depth_pace.h"

#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/sensor_view.h"

namespace emulator::studio {
namespace {

constexpr double kPicturesPerMoment = kDepth_hz / kMoments_hz;
constexpr double kMoment_ns = 1e9 / kMoments_hz;
constexpr double kInStep = 0.02;  // of the rate
/// A trigger may be late or missed; without one for longer the play stands.
constexpr double kMostAhead_moments = 3;

}  // namespace

DepthExposure nextDepthExposure(rt::Timestamp due, const PlayingMoment& playing) {
  const std::uint32_t count = std::max(depthPictures(playing.moments), 1u);
  const auto wrapped = [count](double picture) {
    const auto k = static_cast<std::int64_t>(picture) % static_cast<std::int64_t>(count);
    return static_cast<std::uint32_t>(k < 0 ? k + count : k);
  };
  const auto period_ns = static_cast<double>(playing.period.count());
  const double ahead =
      period_ns > 0 ? static_cast<double>((due - playing.edge).count()) / period_ns : 1e9;
  if (ahead > kMostAhead_moments || ahead < -kMostAhead_moments)
    return {due, wrapped(std::floor(playing.moment * kPicturesPerMoment))};
  const double exact = (playing.moment + ahead) * kPicturesPerMoment;
  const double picture = std::round(exact);
  if (std::abs(period_ns / kMoment_ns - 1) > kInStep) return {due, wrapped(picture)};
  const double wait_ns = (picture - exact) / kPicturesPerMoment * period_ns;
  return {due + rt::Nanoseconds(std::llround(wait_ns)), wrapped(picture)};
}

}  // namespace emulator::studio
