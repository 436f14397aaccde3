#include "hal/emulated/studio/athlete/composer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace emulator::studio {
namespace {

using Eigen::Vector2d;

constexpr double kHalfStance_m = 0.105;
constexpr double kUpright_m = 0.962;

double nearest(double angle, double to) {
  constexpr double kRound = 2 * std::numbers::pi;
  return angle + kRound * std::round((to - angle) / kRound);
}

ArmPosture relaxedArm(Random& random) {
  ArmPosture arm = armTowards({0.15 + 0.03 * random.unit(), -0.02, -0.98},
                              {0.09, 0.20 + 0.12 * random.unit(), -0.96});
  arm.pronation = 0.35;
  arm.grip = 0.42;
  return arm;
}

ArmPosture holdingArm() {
  ArmPosture arm = armTowards({0.30, 0.22, -0.93}, {-0.42, 0.88, 0.16});
  arm.pronation = -0.15;
  arm.grip = 0.22;
  return arm;
}

/// How a person moves on: a step's length in time and space, and what the body does in it.
struct Gait {
  double step_s, step_m;
  double lift_m;
  double double_support;  ///< of a step; negative: a flight
  double ahead;           ///< of a step: where the foot lands before the trunk
  double half_width_m;
  double bob_m, height_m, sway_m;
  double lean, arm_swing, elbow, push_off, heel_strike;
};
constexpr Gait kWalk{.step_s = 0.53,
                     .step_m = 0.66,
                     .lift_m = 0.065,
                     .double_support = 0.14,
                     .ahead = 0.57,
                     .half_width_m = 0.070,
                     .bob_m = 0.016,
                     .height_m = 0.955,
                     .sway_m = 0.018,
                     .lean = 0.04,
                     .arm_swing = 0.42,
                     .elbow = 0.35,
                     .push_off = 0.50,
                     .heel_strike = -0.28};
constexpr Gait kRun{.step_s = 0.34,
                    .step_m = 0.86,
                    .lift_m = 0.24,
                    .double_support = -0.36,
                    .ahead = 0.27,
                    .half_width_m = 0.045,
                    .bob_m = 0.026,
                    .height_m = 0.925,
                    .sway_m = 0.008,
                    .lean = 0.15,
                    .arm_swing = 0.62,
                    .elbow = 1.45,
                    .push_off = 0.80,
                    .heel_strike = -0.10};

/// A way without corners, by length.
class Way {
 public:
  explicit Way(std::vector<Vector2d> corners) : points_(std::move(corners)) {
    for (int round = 0; round < 5; ++round) {  // corner cutting, Chaikin 1974
      std::vector<Vector2d> smoother{points_.front()};
      for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        smoother.push_back(points_[i] * 0.75 + points_[i + 1] * 0.25);
        smoother.push_back(points_[i] * 0.25 + points_[i + 1] * 0.75);
      }
      smoother.push_back(points_.back());
      points_ = std::move(smoother);
    }
    lengths_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
    }
  }
  [[nodiscard]] double length() const { return lengths_.back(); }
  [[nodiscard]] Vector2d at(double s) const {
    const auto i = segment(s);
    const double span = lengths_[i + 1] - lengths_[i];
    const double x = span > 0 ? (s - lengths_[i]) / span : 0;
    return points_[i] + (points_[i + 1] - points_[i]) * std::clamp(x, 0.0, 1.0);
  }
  [[nodiscard]] double heading(double s) const {
    const Vector2d d = at(std::min(s + 0.15, length())) - at(std::max(s - 0.15, 0.0));
    return std::atan2(-d.x(), d.y());
  }

 private:
  [[nodiscard]] std::size_t segment(double s) const {
    const auto next = std::ranges::upper_bound(lengths_, s);
    const auto i = static_cast<std::size_t>(next - lengths_.begin());
    return std::clamp<std::size_t>(i, 1, lengths_.size() - 1) - 1;
  }

  std::vector<Vector2d> points_;
  std::vector<double> lengths_;
};

}  // namespace

Composer::Composer(std::uint64_t seed, const Vector2d& home, double heading, bool left_handed)
    : random_(seed),
      place_(home),
      heading_(heading),
      throw_heading_(heading),
      left_handed_(left_handed) {
  for (const Side side : kSides) {
    const double out = side == Side::kRight ? 1 : -1;
    foot(side).start = beside(home, heading, out * kHalfStance_m, 0);
    foot(side).start_yaw = heading - out * 0.12;
    foot(side).pitch.key(0, 0);
  }
  rest(0);
}

Vector2d Composer::beside(const Vector2d& at, double heading, double x, double y) const {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  return at + Vector2d{c * x - s * y, s * x + c * y};
}

void Composer::begin(Action action, Phase phase_now) {
  actions_.push_back({action, now_, now_});
  phase(now_, phase_now);
}

void Composer::end(double t) {
  now_ = t;
  actions_.back().to = t;
}

void Composer::rest(double t) {
  score_.pelvis(t, place_, kUpright_m);
  score_.heading.key(t, heading_);
  score_.pelvis_bend.key(t, 0.02);
  score_.pelvis_side.key(t, 0);
  score_.trunk(t, {0.04, 0, 0});
  score_.head_bend.key(t, -0.02);
  score_.head_turn.key(t, 0);
  for (const Side side : kSides) {
    arm(side).key(t, holds_ball_ ? holdingArm() : relaxedArm(random_));
  }
}

void Composer::step(Side side, double lift_off, double touch_down, const Vector2d& to, double yaw,
                    double height_m) {
  FootScore& moved = foot(side);
  moved.steps.push_back({lift_off, touch_down, to, nearest(yaw, moved.yaw()), height_m});
}

void Composer::takeBall() {
  if (holds_ball_) return;
  holds_ball_ = true;
  ball_.push_back({BallEvent::Kind::kHold, now_, left_handed_ ? Side::kLeft : Side::kRight});
  rest(now_);
}

void Composer::stand(double seconds) {
  begin(Action::kStand, Phase::kStand);
  // Weight goes from leg to leg, the head looks around.
  const double from = now_;
  const double to = now_ + seconds;
  for (double t = from + 0.7; t < to - 0.5; t += vary(0.9, 0.2)) {
    score_.pelvis(t,
                  beside(place_, heading_, random_.uniform(-0.025F, 0.025F),
                         random_.uniform(-0.012F, 0.012F)),
                  kUpright_m - 0.006);
    score_.trunk(t, {0.04 + random_.uniform(-0.02F, 0.03F), random_.uniform(-0.03F, 0.03F),
                     random_.uniform(-0.05F, 0.05F)});
    score_.head_turn.key(t, random_.uniform(-0.35F, 0.35F));
    score_.head_bend.key(t, random_.uniform(-0.05F, 0.12F));
    for (const Side side : kSides) {
      arm(side).key(t, holds_ball_ ? holdingArm() : relaxedArm(random_));
    }
  }
  rest(to);
  end(to);
}

void Composer::shift(const Vector2d& to, double heading) {
  heading = nearest(heading, heading_);
  const double far = (to - place_).norm();
  const double turn = heading - heading_;
  if (far < 0.03 && std::abs(turn) < 0.05) return;
  const int steps = 1 + static_cast<int>(std::ceil(std::max(far / 0.38, std::abs(turn) / 0.6)));
  constexpr double kStep_s = 0.46;
  const Vector2d from = place_;
  const double from_heading = heading_;
  // The foot on the inside of the turn, or of the way, goes first.
  const Vector2d right = beside(Vector2d::Zero(), heading_, 1, 0);
  const double rightwards = (to - from).dot(right) - 0.3 * turn;
  Side side = rightwards > 0 ? Side::kRight : Side::kLeft;
  begin(Action::kWalk, Phase::kWalk);
  rest(now_);
  for (int i = 1; i <= steps + 1; ++i) {
    const double t = now_ + kStep_s * (i - 1);
    const double part = std::min(static_cast<double>(i) / steps, 1.0);
    const Vector2d at = from + (to - from) * part;
    const double h = from_heading + turn * part;
    const double out = side == Side::kRight ? 1 : -1;
    step(side, t + 0.06, t + kStep_s - 0.02, beside(at, h, out * kHalfStance_m, 0), h - out * 0.12,
         0.05);
    const double lean = static_cast<double>(i) / (steps + 1);
    const Vector2d middle = from + (to - from) * ease(lean);
    const double h_now = from_heading + turn * ease(lean);
    if (i <= steps) {
      score_.pelvis(t + kStep_s / 2, beside(middle, h_now, -out * 0.03, 0), kUpright_m - 0.012);
      score_.heading.key(t + kStep_s / 2, h_now);
    }
    side = side == Side::kRight ? Side::kLeft : Side::kRight;
  }
  place_ = to;
  heading_ = heading;
  const double done = now_ + kStep_s * (steps + 1);
  rest(done + 0.1);
  end(done + 0.1);
}

void Composer::travel(const std::vector<Vector2d>& way, bool run) {
  std::vector<Vector2d> corners{place_};
  corners.insert(corners.end(), way.begin(), way.end());
  const Way path(corners);
  shift(place_, path.heading(0));
  const Gait& gait = run ? kRun : kWalk;
  const double tempo = 1 + random_.uniform(-0.06F, 0.06F);
  const double step_s = gait.step_s / tempo;
  const int steps = std::max(2, static_cast<int>(std::lround(path.length() / gait.step_m)));

  begin(run ? Action::kRun : Action::kWalk, run ? Phase::kRun : Phase::kWalk);
  // Way covered at the start of each step: the first and last are short.
  std::vector<double> covered{0};
  for (int k = 0; k < steps; ++k) {
    const bool border = k == 0 || k + 1 == steps;
    covered.push_back(covered.back() + (border ? 0.55 : 1.0));
  }
  for (double& s : covered) s *= path.length() / covered.back();
  const auto sAt = [&](int k) {
    return covered[static_cast<std::size_t>(std::clamp(k, 0, steps))];
  };
  const double start = now_ + 0.15;
  const auto at = [&](double k) { return start + k * step_s; };

  rest(now_);
  Side side = random_.unit() < 0.5 ? Side::kRight : Side::kLeft;
  for (int k = 1; k <= steps + 1; ++k) {
    // Swing of step k: touches down at k, before the trunk.
    const double s = std::min(sAt(k) + gait.ahead * (sAt(k + 1) - sAt(k)), path.length());
    const double h = path.heading(s);
    const double out = side == Side::kRight ? 1 : -1;
    const bool last = k == steps + 1;
    const double width = last || k == steps ? kHalfStance_m : gait.half_width_m;
    const double off = std::max(at(k - 1 + gait.double_support), foot(side).free() + 0.10 * step_s);
    const double on = at(k);
    const double strength = k == 1 || last ? 0.45 : 1.0;
    step(side, off, on, beside(path.at(s), h, out * width, 0), h - out * 0.10,
         gait.lift_m * (k == 1 || last ? 0.6 : 1.0));
    Curve& pitch = foot(side).pitch;
    pitch.key(off - 0.42 * step_s, 0);
    pitch.key(off + 0.02 * step_s, gait.push_off * strength);
    pitch.key(off + 0.5 * (on - off), gait.push_off * (run ? 0.9 : 0.25) * strength);
    pitch.key(on - 0.01, last ? 0.0 : gait.heel_strike * strength);
    pitch.key(on + 0.25 * step_s, 0);

    // The trunk halfway between touch-downs k - 1 and k: over the other foot.
    const double middle_s = (sAt(k - 1) + sAt(k)) / 2;
    const double middle_h = path.heading(middle_s);
    const double away = run ? -1.0 : 1.0;  // a runner is lowest over the foot, a walker highest
    if (k <= steps) {
      score_.pelvis(at(k - 0.5), beside(path.at(middle_s), middle_h, -out * gait.sway_m, 0),
                    gait.height_m + away * gait.bob_m);
      score_.pelvis_side.key(at(k - 0.5), out * 0.05);
      const double h_k = path.heading(sAt(k));
      score_.pelvis(at(k), path.at(sAt(k)), gait.height_m - away * gait.bob_m);
      score_.pelvis_side.key(at(k), 0);
      // The pelvis follows the leg that swings forward, the chest turns against it.
      const double twist = out * (run ? 0.12 : 0.09) * strength;
      score_.heading.key(at(k), nearest(h_k, score_.heading.last()) + twist);
      score_.trunk(at(k), {0.04 + gait.lean * strength, 0, -1.9 * twist});
      score_.head_turn.key(at(k), 0.8 * twist);
      score_.head_bend.key(at(k), -0.5 * gait.lean);
      score_.pelvis_bend.key(at(k), 0.3 * gait.lean);
      for (const Side s2 : kSides) {
        // The arm on the swinging leg's side goes back.
        const double swing = (s2 == side ? -0.85 : 1.0) * gait.arm_swing * strength;
        const double elbow = gait.elbow + (s2 == side ? -0.12 : 0.25) * strength;
        ArmPosture a = armTowards({0.16, std::sin(swing), -std::cos(swing)},
                                  {0.05, std::sin(swing + elbow), -std::cos(swing + elbow)});
        a.pronation = run ? 0.1 : 0.35;
        a.grip = run ? 0.75 : 0.42;
        if (holds_ball_ && s2 == (left_handed_ ? Side::kLeft : Side::kRight)) a.grip = 0.25;
        arm(s2).key(at(k), a);
      }
    }
    side = side == Side::kRight ? Side::kLeft : Side::kRight;
  }
  place_ = path.at(path.length());
  heading_ = nearest(path.heading(path.length()), score_.heading.last());
  const double done = at(steps + 1);
  rest(done + 0.25);
  end(done + 0.25);
}

}  // namespace emulator::studio
