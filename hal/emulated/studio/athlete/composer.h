#pragma once

#include <vector>

#include <Eigen/Core>

#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/athlete/score.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {

/// The ball's part of a performance: it is in the hand from `from` on, or flies to a catch.
struct BallEvent {
  enum class Kind { kHold, kRelease, kArrive } kind = Kind::kHold;
  double t = 0;  ///< kArrive: of the catch
  Side hand = Side::kRight;
};

/// Writes a score action by action: each starts where and when the last one ended, upright,
/// both feet on the floor. All lengths are metres at kRestHeight_m.
class Composer {
 public:
  Composer(std::uint64_t seed, const Eigen::Vector2d& home, double heading, bool left_handed);

  void stand(double seconds);
  /// Along @p way, from where the person stands, facing along it. @p run: else walks.
  void travel(const std::vector<Eigen::Vector2d>& way, bool run);
  /// In small steps to a place and a heading.
  void shift(const Eigen::Vector2d& to, double heading);
  /// kThrow, kSlowThrow or kAbortedThrow towards @p heading.
  void throwBall(Action kind);
  void catchBall();
  void stretch();

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] bool holdsBall() const { return holds_ball_; }
  void takeBall();

  [[nodiscard]] const Score& score() const { return score_; }
  [[nodiscard]] const std::vector<ThrowTruth>& throws() const { return throws_; }
  [[nodiscard]] const std::vector<ActionTruth>& actions() const { return actions_; }
  [[nodiscard]] const std::vector<BallEvent>& ball() const { return ball_; }
  [[nodiscard]] const std::vector<std::pair<double, Phase>>& phases() const { return phases_; }
  [[nodiscard]] Random& random() { return random_; }
  [[nodiscard]] Eigen::Vector2d place() const { return place_; }

 private:
  friend class ThrowWriter;

  /// In the axes of the person: x right, y forward.
  [[nodiscard]] Eigen::Vector2d beside(const Eigen::Vector2d& at, double heading, double x,
                                       double y) const;
  [[nodiscard]] FootScore& foot(Side side) { return score_.feet[static_cast<std::size_t>(side)]; }
  [[nodiscard]] ArmScore& arm(Side side) { return score_.arms[static_cast<std::size_t>(side)]; }
  void begin(Action action, Phase phase);
  void end(double t);
  void phase(double t, Phase phase) { phases_.emplace_back(t, phase); }
  /// Upright and relaxed, or with the ball before the chest, at @p t.
  void rest(double t);
  void step(Side side, double lift_off, double touch_down, const Eigen::Vector2d& to, double yaw,
            double height_m);
  [[nodiscard]] double vary(double value, double part) {
    return value * (1 + random_.uniform(static_cast<float>(-part), static_cast<float>(part)));
  }

  Random random_;
  Score score_;
  double now_ = 0;
  Eigen::Vector2d place_;
  double heading_;
  double throw_heading_;
  bool left_handed_;
  bool holds_ball_ = false;
  std::vector<ThrowTruth> throws_;
  std::vector<ActionTruth> actions_;
  std::vector<BallEvent> ball_;
  std::vector<std::pair<double, Phase>> phases_;
};

}  // namespace emulator::studio
