#include "hal/emulated/studio/athlete/performance.h"

#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/ball_flight.h"
#include "hal/emulated/studio/athlete/composer.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPass_s = 0.62;       // a partner's pass is in the air
constexpr double kOutOfSight_s = 1.6;  // a thrown ball is shown

/// A practice: the actions of one round in random order. A throw comes first, because a scene that
/// is still being drawn shows its beginning only. The athlete never stretches with the ball in
/// hand.
std::vector<Action> practice(Random& random) {
  using enum Action;
  std::vector<Action> round = {kThrow, kCatch, kThrow, kCatch, kSlowThrow};
  for (const Action action : {kWalk, kAbortedThrow, kRun}) {
    const auto at = static_cast<std::ptrdiff_t>(1 + random.next() % round.size());
    round.insert(round.begin() + at, action);
  }
  auto after = random.next() % 3;
  for (auto at = round.begin(); at != round.end(); ++at) {
    if ((*at != kThrow && *at != kSlowThrow) || after-- != 0) continue;
    round.insert(at + 1, kStretch);
    break;
  }
  return round;
}

std::vector<Vector2d> loopAround(const Vector2d& home, double heading, bool run) {
  const double wide = run ? 2.2 : 1.5;
  const double long_way = run ? 2.6 : 1.9;
  const Eigen::Rotation2Dd turn(heading);
  std::vector<Vector2d> way;
  for (const Vector2d& corner :
       {Vector2d{wide, 0.2}, Vector2d{wide, -long_way}, Vector2d{-wide, -long_way},
        Vector2d{-wide, -0.6}, Vector2d{-0.3, -0.5}, Vector2d{0, 0}}) {
    way.emplace_back(home + turn * corner);
  }
  return way;
}

}  // namespace

std::string_view name(Action action) {
  switch (action) {
    case Action::kStand:
      return "stand";
    case Action::kWalk:
      return "walk";
    case Action::kRun:
      return "run";
    case Action::kThrow:
      return "throw";
    case Action::kSlowThrow:
      return "slow_throw";
    case Action::kAbortedThrow:
      return "aborted_throw";
    case Action::kCatch:
      return "catch";
    case Action::kStretch:
      return "stretch";
  }
  return "?";
}

std::string_view name(Phase phase) {
  switch (phase) {
    case Phase::kStand:
      return "stand";
    case Phase::kWalk:
      return "walk";
    case Phase::kRun:
      return "run";
    case Phase::kWindUp:
      return "wind_up";
    case Phase::kStride:
      return "stride";
    case Phase::kArmCocking:
      return "arm_cocking";
    case Phase::kArmAcceleration:
      return "arm_acceleration";
    case Phase::kArmDeceleration:
      return "arm_deceleration";
    case Phase::kFollowThrough:
      return "follow_through";
    case Phase::kRecovery:
      return "recovery";
    case Phase::kCatch:
      return "catch";
    case Phase::kStretch:
      return "stretch";
  }
  return "?";
}

struct Performance::Plan {
  double height_m;
  double ball_radius_m;
  Score score;
  double duration = 0;
  std::vector<ThrowTruth> throws;
  std::vector<ActionTruth> actions;
  std::vector<std::pair<double, Phase>> phases;

  struct Held {
    double from, to;
    Side hand;
  };
  std::vector<Held> held;
  std::vector<BallFlight> flights;

  [[nodiscard]] PosedSkeleton posed(double t) const { return poseSkeleton(score.at(t), height_m); }
  [[nodiscard]] Vector3d inHand(double t, Side hand) const {
    return posed(t).heldBall(hand, ball_radius_m);
  }
  void followBall(const std::vector<BallEvent>& events, double heading);
};

void Performance::Plan::followBall(const std::vector<BallEvent>& events, double heading) {
  const Vector3d ahead{-std::sin(heading), std::cos(heading), 0};
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto& event = events[i];
    const double next = i + 1 < events.size() ? events[i + 1].t : duration;
    if (event.kind == BallEvent::Kind::kRelease) {
      constexpr double kStep = 0.004;
      const Vector3d from = inHand(event.t, event.hand);
      const Vector3d hand_velocity = (from - inHand(event.t - kStep, event.hand)) / kStep;
      // The fingers send it where he looks, a little upwards, as fast as the hand.
      const Vector3d aim = (ahead + Vector3d{0, 0, 0.06}).normalized();
      const double speed = std::max(hand_velocity.norm(), 7.0);
      flights.push_back({event.t, event.t + kOutOfSight_s, from,
                         (0.25 * hand_velocity.normalized() + 0.75 * aim).normalized() * speed,
                         ball_radius_m});
      continue;
    }
    if (event.kind == BallEvent::Kind::kArrive) {
      const Vector3d caught = inHand(event.t, event.hand);
      const Vector3d start =
          Vector3d{caught.x(), caught.y(), 0} + 7.0 * ahead + Vector3d{0, 0, 1.4};
      flights.push_back({event.t - kPass_s, event.t, start, launchVelocity(start, caught, kPass_s),
                         ball_radius_m});
    }
    held.push_back({event.t, next, event.hand});
  }
}

Performance::Performance(std::uint64_t seed, const PerformanceOptions& options)
    : plan_(std::make_unique<Plan>()) {
  plan_->height_m = options.shape.height_m;
  plan_->ball_radius_m = options.ball_radius_m;
  const double scale = options.shape.height_m / kRestHeight_m;
  Composer composer(seed, options.home / scale, options.heading, options.shape.left_handed);

  const auto travel = [&](bool run) {
    auto way =
        options.route.empty() ? loopAround(options.home, options.heading, run) : options.route;
    if (!options.route.empty()) way.push_back(options.route.front());
    for (auto& corner : way) corner /= scale;
    composer.travel(way, run);
  };
  // Who only practises comes with the ball in hand.
  if (options.actions.empty() && options.ball_radius_m > 0) composer.takeBall();
  composer.stand(0.5);
  std::vector<Action> next;
  while (composer.now() < options.least_duration_s) {
    if (next.empty()) {
      next = options.actions.empty() ? practice(composer.random()) : options.actions;
      std::ranges::reverse(next);
    }
    const Action action = next.back();
    next.pop_back();
    const bool throws =
        action == Action::kThrow || action == Action::kSlowThrow || action == Action::kAbortedThrow;
    // A throw needs the ball and begins at its own place.
    if (throws || action == Action::kCatch) {
      if ((composer.place() - options.home / scale).norm() > 0.6) {
        composer.shift(options.home / scale, options.heading);
      }
      if (throws && options.ball_radius_m > 0 && !composer.holdsBall()) composer.catchBall();
    }
    switch (action) {
      case Action::kStand:
        composer.stand(2.5);
        break;
      case Action::kWalk:
        travel(false);
        break;
      case Action::kRun:
        travel(true);
        break;
      case Action::kCatch:
        composer.catchBall();
        break;
      case Action::kStretch:
        composer.stretch();
        break;
      default:
        composer.throwBall(action);
    }
    composer.stand(composer.random().uniform(0.5F, 1.4F));
  }
  plan_->score = composer.score();
  plan_->duration = composer.now();
  plan_->throws = composer.throws();
  plan_->actions = composer.actions();
  plan_->phases = composer.phases();
  if (options.ball_radius_m > 0) plan_->followBall(composer.ball(), options.heading);
}

Performance::~Performance() = default;
Performance::Performance(Performance&&) noexcept = default;
Performance& Performance::operator=(Performance&&) noexcept = default;

double Performance::duration() const {
  return plan_->duration;
}
const std::vector<ThrowTruth>& Performance::throws() const {
  return plan_->throws;
}
const std::vector<ActionTruth>& Performance::actions() const {
  return plan_->actions;
}

PoseAt Performance::at(double t) const {
  t = std::clamp(t, 0.0, plan_->duration);
  const PosedSkeleton posed = plan_->posed(t);
  PoseAt pose;
  pose.bones.reserve(kBones);
  for (const auto& bone : posed.bones) pose.bones.emplace_back(bone.cast<float>());
  pose.joints = posed.joints;
  pose.ball_radius_m = plan_->ball_radius_m;
  const auto& phases = plan_->phases;
  const auto after =
      std::ranges::upper_bound(phases, t, {}, [](const auto& entry) { return entry.first; });
  if (after != phases.begin()) pose.phase = std::prev(after)->second;
  for (const auto& held : plan_->held) {
    if (t < held.from || t >= held.to) continue;
    pose.ball_state = BallState::kHeld;
    pose.ball = posed.heldBall(held.hand, pose.ball_radius_m);
  }
  for (const auto& flight : plan_->flights) {
    if (t < flight.from || t >= flight.to) continue;
    pose.ball_state = BallState::kFlying;
    pose.ball = flight.at(t);
  }
  return pose;
}

}  // namespace emulator::studio
