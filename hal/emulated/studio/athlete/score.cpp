#include "hal/emulated/studio/athlete/score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace emulator::studio {
namespace {

/// Up and down again without velocity and acceleration at both ends.
double bump(double x) {
  if (x <= 0 || x >= 1) return 0;
  const double y = x * (1 - x);
  return 64 * y * y * y;
}

}  // namespace

FootPosture FootScore::at(double t) const {
  FootPosture foot;
  foot.pitch = pitch.at(t);
  foot.sole = {start.x(), start.y(), 0};
  foot.yaw = start_yaw;
  const auto next = std::ranges::upper_bound(steps, t, {}, &Step::lift_off);
  if (next == steps.begin()) return foot;
  const auto i = static_cast<std::size_t>(next - steps.begin()) - 1;
  const Step& step = steps[i];
  const Eigen::Vector2d from = i > 0 ? steps[i - 1].to : start;
  const double from_yaw = i > 0 ? steps[i - 1].yaw : start_yaw;
  const double x = (t - step.lift_off) / (step.touch_down - step.lift_off);
  // Up before forwards, down after: a sole never rubs along the floor.
  const double done = ease((x - 0.07) / 0.86);
  const Eigen::Vector2d place = from + (step.to - from) * done;
  foot.sole = {place.x(), place.y(), step.height_m * bump(x)};
  foot.yaw = from_yaw + (step.yaw - from_yaw) * done;
  foot.toes = 1 - bump(x);  // in the air the toes follow the foot
  return foot;
}

void ArmScore::key(double t, const ArmPosture& arm) {
  swing_forward.key(t, arm.swing_forward);
  swing_up.key(t, arm.swing_up);
  double turn = arm.twist;
  if (!twist.empty()) {
    constexpr double kRound = 2 * std::numbers::pi;
    turn += kRound * std::round((twist.last() - turn) / kRound);
  }
  twist.key(t, turn);
  elbow.key(t, arm.elbow);
  pronation.key(t, arm.pronation);
  wrist.key(t, arm.wrist);
  grip.key(t, arm.grip);
}

ArmPosture ArmScore::at(double t) const {
  ArmPosture arm;
  arm.swing_forward = swing_forward.at(t);
  arm.swing_up = swing_up.at(t);
  arm.twist = twist.at(t);
  arm.elbow = elbow.at(t);
  arm.pronation = pronation.at(t);
  arm.wrist = wrist.at(t);
  arm.grip = grip.at(t);
  return arm;
}

void Score::trunk(double t, const TrunkPosture& trunk) {
  bend.key(t, trunk.bend);
  side.key(t, trunk.side);
  turn.key(t, trunk.turn);
}

void Score::pelvis(double t, const Eigen::Vector2d& at, double height) {
  pelvis_x.key(t, at.x());
  pelvis_y.key(t, at.y());
  pelvis_z.key(t, height);
}

Posture Score::at(double t) const {
  Posture p;
  p.pelvis = {pelvis_x.at(t), pelvis_y.at(t), pelvis_z.at(t)};
  p.heading = heading.at(t);
  p.pelvis_bend = pelvis_bend.at(t);
  p.pelvis_side = pelvis_side.at(t);
  p.spine_bend = 0.45 * bend.at(t);
  p.chest_bend = 0.55 * bend.at(t);
  p.spine_side = 0.5 * side.at(t) - 0.5 * p.pelvis_side;
  p.chest_side = 0.5 * side.at(t) - 0.5 * p.pelvis_side;
  p.spine_turn = 0.35 * turn.at(t);
  p.chest_turn = 0.65 * turn.at(t);
  p.head_bend = head_bend.at(t);
  p.head_turn = head_turn.at(t);
  p.head_side = -0.5 * side.at(t);
  for (std::size_t s = 0; s < 2; ++s) {
    p.arms[s] = arms[s].at(t);
    p.feet[s] = feet[s].at(t);
    p.knee_out[s] = 0.08;
  }
  return p;
}

}  // namespace emulator::studio
