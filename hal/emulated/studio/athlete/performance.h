#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

enum class Action : std::uint8_t {
  kStand,
  kWalk,
  kRun,
  kThrow,
  kSlowThrow,     ///< rehearsal: the same movement at a third of the speed, ball kept
  kAbortedThrow,  ///< broken off while the arm is cocked
  kCatch,
  kStretch,
};

/// Where in an action a moment lies. The phases of a throw follow Fleisig et al. 1995.
enum class Phase : std::uint8_t {
  kStand,
  kWalk,
  kRun,
  kWindUp,
  kStride,
  kArmCocking,
  kArmAcceleration,
  kArmDeceleration,
  kFollowThrough,
  kRecovery,
  kCatch,
  kStretch,
};
[[nodiscard]] std::string_view name(Action action);
[[nodiscard]] std::string_view name(Phase phase);

enum class BallState : std::uint8_t { kNone, kHeld, kFlying };

struct PoseAt {
  /// One per bone of a Body: posed * inverse rest, rig frame. They also scale the body to its
  /// height, so normals need normalising.
  std::vector<Eigen::Affine3f> bones;
  std::array<Eigen::Vector3d, 17> joints;  ///< COCO order, centres of the joints, rig frame
  Eigen::Vector3d ball = Eigen::Vector3d::Zero();
  double ball_radius_m = 0;
  BallState ball_state = BallState::kNone;
  Phase phase = Phase::kStand;
};

/// A throw's instants in seconds of the performance. An aborted or slow throw has no release of
/// the ball: `release` is then the instant in which the arm passes where it would be.
struct ThrowTruth {
  Action kind = Action::kThrow;
  bool left_handed = false;
  double wind_up = 0;
  double stride = 0;        ///< front foot leaves the floor
  double foot_contact = 0;  ///< front foot stands
  double max_external_rotation = 0;
  double release = 0;
  double max_internal_rotation = 0;
  double end = 0;
  double speed = 1;   ///< against the person's usual tempo
  double height = 0;  ///< -1 sidearm .. 1 straight over the head
};

struct ActionTruth {
  Action action = Action::kStand;
  double from = 0;
  double to = 0;
};

struct PerformanceOptions {
  BodyShape shape;
  double heading = 0;          ///< the throws' direction, counter-clockwise from +y
  Eigen::Vector2d home{0, 0};  ///< where the person works, rig frame
  /// What to do, in order, again and again; empty: a practice of everything, drawn by the seed.
  std::vector<Action> actions;
  /// Corners of the way of kWalk and kRun, rig frame, closed; empty: a loop around home.
  std::vector<Eigen::Vector2d> route;
  double least_duration_s = 60;
  double ball_radius_m = 0.093;  ///< a men's handball; 0: no ball
};

/// What one person does over a minute or more. Feet that stand do not slide, joints stay within
/// their limits, positions have continuous acceleration but where a ball is caught or bounces.
/// The same seed and options give the same performance.
///
/// Threads  const after construction, any.
class Performance {
 public:
  Performance(std::uint64_t seed, const PerformanceOptions& options);
  ~Performance();
  Performance(Performance&&) noexcept;
  Performance& operator=(Performance&&) noexcept;

  /// Seconds; at() repeats the last moment beyond it.
  [[nodiscard]] double duration() const;
  [[nodiscard]] PoseAt at(double t) const;
  [[nodiscard]] const std::vector<ThrowTruth>& throws() const;
  [[nodiscard]] const std::vector<ActionTruth>& actions() const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace emulator::studio
