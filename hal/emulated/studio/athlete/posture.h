#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {

/// Where an arm points, in the chest's axes of a right arm (x out, y forward, z up; a left arm is
/// its mirror image): the swing of the upper arm away from its rest direction as a rotation
/// vector without twist, then twist about the arm and flexion of the elbow. Radians.
struct ArmPosture {
  double swing_forward = 0;  ///< about the vertical: arm forwards
  double swing_up = 0;       ///< about the forward axis: arm up
  double twist = 0;          ///< about the arm: positive turns the forearm's front upwards
  double elbow = 0.25;       ///< 0 straight .. 2.5
  double pronation = 0;      ///< palm turns downwards (thumb inwards), -1.4 .. 1.4
  double wrist = 0;          ///< positive towards the palm
  double grip = 0.35;        ///< fingers: 0 flat .. 1 around a small thing
  double shrug = 0;          ///< shoulder girdle upwards
  double reach = 0;          ///< shoulder girdle forwards
};

/// The arm whose upper arm and forearm point along @p upper and @p fore (chest's axes, right arm).
[[nodiscard]] ArmPosture armTowards(const Eigen::Vector3d& upper, const Eigen::Vector3d& fore);

/// A foot's sole in the rig frame: the point of the floor under its ankle when it stands flat.
struct FootPosture {
  Eigen::Vector3d sole = Eigen::Vector3d::Zero();
  double yaw = 0;    ///< heading, counter-clockwise from +y
  double pitch = 0;  ///< positive: on the ball, heel up; negative: on the heel, toes up
  double toes = 1;   ///< how far the toes stay on the floor when the heel rises, 0..1
};

/// Everything that moves, in metres at kRestHeight_m and radians. Angles of the trunk are those of
/// each part against the one below, positive: bend forwards, to the right, turn to the left.
struct Posture {
  Eigen::Vector3d pelvis{0, 0, 0.965};
  double heading = 0;  ///< of the pelvis, counter-clockwise from +y
  double pelvis_bend = 0, pelvis_side = 0;
  double spine_bend = 0, spine_side = 0, spine_turn = 0;
  double chest_bend = 0, chest_side = 0, chest_turn = 0;
  double head_bend = 0, head_side = 0, head_turn = 0;
  std::array<ArmPosture, 2> arms;    ///< by Side
  std::array<FootPosture, 2> feet;   ///< by Side
  std::array<double, 2> knee_out{};  ///< knees away from the middle
};

/// Bones of a posture.
struct PosedSkeleton {
  std::array<Eigen::Affine3d, kBones> bones;  ///< rest to rig frame, metres, scaled to the body
  std::array<Eigen::Vector3d, 17> joints;     ///< COCO order, rig frame
  /// Where a ball lies in each hand (centre for a radius), and the direction out of the palm.
  [[nodiscard]] Eigen::Vector3d heldBall(Side side, double radius_m) const;
};

/// Places the bones: trunk and arms by their angles, legs by two-bone inverse kinematics so that
/// the feet are exactly where they stand. A pelvis too high for the legs is lowered smoothly.
/// @p height_m  of the person.
[[nodiscard]] PosedSkeleton poseSkeleton(const Posture& posture, double height_m);

}  // namespace emulator::studio
