#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "hal/emulated/studio/athlete/curve.h"
#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/athlete/posture.h"

namespace emulator::studio {

/// A foot's way through the air. Between steps it stands still.
struct Step {
  double lift_off = 0, touch_down = 0;
  Eigen::Vector2d to{0, 0};
  double yaw = 0;
  double height_m = 0.06;
};

struct FootScore {
  Eigen::Vector2d start{0, 0};
  double start_yaw = 0;
  std::vector<Step> steps;
  Curve pitch;

  [[nodiscard]] FootPosture at(double t) const;
  /// Where it stands after all steps so far.
  [[nodiscard]] Eigen::Vector2d place() const { return steps.empty() ? start : steps.back().to; }
  [[nodiscard]] double yaw() const { return steps.empty() ? start_yaw : steps.back().yaw; }
  [[nodiscard]] double free() const { return steps.empty() ? 0 : steps.back().touch_down; }
};

struct ArmScore {
  Curve swing_forward, swing_up, twist, elbow, pronation, wrist, grip;

  /// Turns the short way round from the last key.
  void key(double t, const ArmPosture& arm);
  [[nodiscard]] ArmPosture at(double t) const;
};

struct TrunkPosture {
  double bend = 0, side = 0, turn = 0;  ///< of spine and chest together
};

/// All curves of a performance: metres at kRestHeight_m, in the rig's axes.
struct Score {
  Curve pelvis_x, pelvis_y, pelvis_z, heading, pelvis_bend, pelvis_side;
  Curve bend, side, turn;
  Curve head_bend, head_turn;
  std::array<ArmScore, 2> arms;  ///< by Side
  std::array<FootScore, 2> feet;

  void trunk(double t, const TrunkPosture& trunk);
  void pelvis(double t, const Eigen::Vector2d& at, double height);
  [[nodiscard]] Posture at(double t) const;
};

}  // namespace emulator::studio
