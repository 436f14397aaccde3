#include "hal/emulated/studio/athlete/posture.h"

#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/curve.h"
#include "hal/emulated/studio/athlete/tailor.h"

namespace emulator::studio {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kAnkleHeight_m = 0.088 + kSoleDepth_m;
constexpr double kBallOfFoot_m = 0.132;  // before the ankle
constexpr double kHeel_m = 0.055;        // behind it
constexpr double kLegReach = 0.9985;     // of a stretched leg

Matrix3d aboutX(double angle) {
  return AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
}
Matrix3d aboutY(double angle) {
  return AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
}
Matrix3d aboutZ(double angle) {
  return AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}
Matrix3d about(const Vector3d& axis, double angle) {
  return AngleAxisd(angle, axis).toRotationMatrix();
}
Matrix3d trunkPart(double bend, double side, double turn) {
  return aboutZ(turn) * aboutX(-bend) * aboutY(side);
}
Matrix3d halfway(const Matrix3d& a, const Matrix3d& b) {
  return Quaterniond(a).slerp(0.5, Quaterniond(b)).toRotationMatrix();
}

Vector3d restJoint(int bone) {
  return restSkeleton()[static_cast<std::size_t>(bone)].joint.cast<double>();
}
Vector3d restJoint(SideBone bone) {
  return restJoint(boneIndex(bone, Side::kRight));
}

Vector3d armAxis() {
  return restArmDirection().cast<double>();
}
/// Out of the back of the hand at rest; the elbow bends about it.
Vector3d backAxis() {
  return armAxis().cross(Vector3d::UnitY());
}

/// Soft minimum: below both, no kink.
double softMin(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * h * blend / 6;
}

/// Positions and rotations of bones, filled from the pelvis outwards.
struct Draft {
  std::array<Vector3d, kBones> joint;
  std::array<Matrix3d, kBones> turn;

  void place(int bone, const Vector3d& position, const Matrix3d& rotation) {
    joint[static_cast<std::size_t>(bone)] = position;
    turn[static_cast<std::size_t>(bone)] = rotation;
  }
  /// At the end of its parent.
  void attach(int bone, const Matrix3d& rotation) {
    const int parent = restSkeleton()[static_cast<std::size_t>(bone)].parent;
    place(bone, carried(parent, restJoint(bone)), rotation);
  }
  /// Where a point of the rest pose goes with a bone.
  [[nodiscard]] Vector3d carried(int bone, const Vector3d& rest) const {
    const auto b = static_cast<std::size_t>(bone);
    return joint[b] + turn[b] * (rest - restJoint(bone));
  }
  [[nodiscard]] const Matrix3d& of(int bone) const { return turn[static_cast<std::size_t>(bone)]; }
};

void poseArm(const ArmPosture& arm, Side side, Draft& draft) {
  using enum SideBone;
  const Matrix3d mirror =
      Vector3d(side == Side::kRight ? 1.0 : -1.0, 1, 1).asDiagonal().toDenseMatrix();
  const auto index = [&](SideBone bone) { return boneIndex(bone, side); };
  const Matrix3d chest = draft.of(boneIndex(MidBone::kChest));
  // Rotations of a right arm in the chest's axes; a left arm is the mirror image.
  const auto attach = [&](SideBone bone, const Matrix3d& right) {
    draft.attach(index(bone), chest * mirror * right * mirror);
  };
  const Vector3d along = armAxis();
  const Vector3d back = backAxis();

  // The girdle follows the arm: up when it is raised, forwards when it reaches.
  const double raised = arm.swing_up + 0.15;
  const double shrug = arm.shrug - 0.07 + 0.16 * (raised + std::sqrt(raised * raised + 0.09));
  const double reach = arm.reach + 0.10 * std::sin(std::clamp(arm.swing_forward, -1.5, 1.5));
  const Matrix3d girdle = aboutZ(reach) * aboutY(-shrug);
  attach(kClavicle, girdle);

  const Vector3d swing = back * arm.swing_forward - Vector3d::UnitY() * arm.swing_up;
  const double angle = swing.norm();
  const Matrix3d upper = angle > 1e-9 ? about(swing / angle, angle) : Matrix3d::Identity();
  const Matrix3d low = upper * about(along, arm.twist);
  const Matrix3d forearm = low * about(back, arm.elbow);
  const Matrix3d forearm_low = forearm * about(along, -0.65 * arm.pronation);
  const Matrix3d hand = forearm * about(along, -arm.pronation) * aboutY(arm.wrist);
  attach(kUpperArm, upper);
  draft.place(index(kShoulderHalf), draft.joint[static_cast<std::size_t>(index(kUpperArm))],
              halfway(draft.of(index(kClavicle)), draft.of(index(kUpperArm))));
  attach(kUpperArmLow, low);
  attach(kForearm, forearm);
  draft.place(index(kElbowHalf), draft.joint[static_cast<std::size_t>(index(kForearm))],
              halfway(draft.of(index(kUpperArmLow)), draft.of(index(kForearm))));
  attach(kForearmLow, forearm_low);
  attach(kHand, hand);

  const Matrix3d thumb = hand * about(along, -0.8 * arm.grip) * about(back, 0.15 - 0.3 * arm.grip);
  attach(kThumb1, thumb);
  attach(kThumb2, thumb * about(back, -0.5 * arm.grip));
  double lag = 0.9;  // the little finger curls most
  for (const SideBone finger : {kIndex1, kMiddle1, kRing1, kLittle1}) {
    const Matrix3d first = hand * aboutY(0.85 * arm.grip * lag);
    attach(finger, first);
    attach(static_cast<SideBone>(static_cast<int>(finger) + 1),
           first * aboutY(1.25 * arm.grip * lag));
    lag += 0.08;
  }
}

Matrix3d footTurn(const FootPosture& foot) {
  return aboutZ(foot.yaw) * aboutX(-foot.pitch);
}

/// The sole rolls over the ball when the heel is up, over the heel when the toes are up.
Vector3d ankleOf(const FootPosture& foot) {
  const double on_ball = ease(foot.pitch / 0.16 + 0.5);
  const Vector3d pivot{0, -kHeel_m + (kBallOfFoot_m + kHeel_m) * on_ball, 0};
  const Vector3d ankle{0, 0, kAnkleHeight_m};
  return foot.sole + aboutZ(foot.yaw) * (pivot + aboutX(-foot.pitch) * (ankle - pivot));
}

/// A bone's rotation that takes its rest direction to @p to and keeps its front in the plane of
/// @p front.
Matrix3d aligned(const Vector3d& rest, const Vector3d& to, const Vector3d& front) {
  const auto frame = [](const Vector3d& along, const Vector3d& forward) {
    Matrix3d f;
    f.col(2) = along.normalized();
    f.col(0) = forward.cross(f.col(2)).normalized();
    f.col(1) = f.col(2).cross(f.col(0));
    return f;
  };
  return frame(to, front) * frame(rest, Vector3d::UnitY()).transpose();
}

void poseLeg(const FootPosture& foot, double knee_out, Side side, Draft& draft) {
  using enum SideBone;
  const auto index = [&](SideBone bone) { return boneIndex(bone, side); };
  const int pelvis = boneIndex(MidBone::kPelvis);
  const Vector3d hip = draft.carried(pelvis, restJoint(index(kThigh)));
  const Vector3d ankle = ankleOf(foot);
  const Vector3d thigh_rest = restJoint(index(kShank)) - restJoint(index(kThigh));
  const Vector3d shank_rest = restJoint(index(kFoot)) - restJoint(index(kShank));
  const double l1 = thigh_rest.norm();
  const double l2 = shank_rest.norm();

  const Vector3d leg = ankle - hip;
  const double d = std::clamp(leg.norm(), std::abs(l1 - l2) + 0.05, kLegReach * (l1 + l2));
  const Vector3d along = leg.normalized();
  // The knee points between the pelvis' front and the toes.
  const double outwards = side == Side::kRight ? 1.0 : -1.0;
  const Vector3d forward = draft.of(pelvis) * Vector3d::UnitY() * 0.45 +
                           aboutZ(foot.yaw) * Vector3d::UnitY() * 0.55 +
                           draft.of(pelvis) * Vector3d::UnitX() * (outwards * knee_out);
  const Vector3d front = (forward - along * forward.dot(along)).normalized();
  const double c = (l1 * l1 + d * d - l2 * l2) / (2 * d);
  const double h = std::sqrt(std::max(l1 * l1 - c * c, 0.0));
  const Vector3d knee = hip + along * c + front * h;
  const Vector3d end = hip + along * d;

  draft.place(index(kThigh), hip, aligned(thigh_rest, knee - hip, front));
  draft.place(index(kHipHalf), hip, halfway(draft.of(pelvis), draft.of(index(kThigh))));
  draft.place(index(kShank), knee, aligned(shank_rest, end - knee, front));
  draft.place(index(kKneeHalf), knee, halfway(draft.of(index(kThigh)), draft.of(index(kShank))));
  draft.place(index(kFoot), end, footTurn(foot));
  const double toes = std::clamp(std::max(foot.pitch, 0.0) * foot.toes, 0.0, 0.9);
  draft.attach(index(kToes), footTurn(foot) * aboutX(toes));
}

/// How high the pelvis may be for both legs to reach their feet.
double reachableHeight(const Posture& posture, const Matrix3d& pelvis_turn) {
  double height = posture.pelvis.z();
  const Vector3d hip_right = restJoint(SideBone::kThigh);
  const double reach =
      kLegReach * ((restJoint(SideBone::kShank) - hip_right).norm() +
                   (restJoint(SideBone::kFoot) - restJoint(SideBone::kShank)).norm());
  for (const Side side : kSides) {
    const Vector3d offset = pelvis_turn * (restJoint(boneIndex(SideBone::kThigh, side)) -
                                           restJoint(boneIndex(MidBone::kPelvis)));
    const Vector3d ankle = ankleOf(posture.feet[static_cast<std::size_t>(side)]);
    const Vector3d hip = posture.pelvis + offset;
    const double away = (ankle - hip).head<2>().norm();
    const double drop = std::sqrt(std::max(reach * reach - away * away, 0.04));
    height = softMin(height, ankle.z() + drop - offset.z(), 0.03);
  }
  return height;
}

std::array<Vector3d, 17> cocoJoints(const Draft& draft) {
  const int head = boneIndex(MidBone::kHead);
  std::array<Vector3d, 17> joints;
  joints[0] = draft.carried(head, {0, 0.114, 1.648});
  std::size_t next = 1;
  for (const Vector3d& rest : {Vector3d{0.0315, 0.085, 1.6855}, Vector3d{0.078, -0.004, 1.668}}) {
    joints[next++] = draft.carried(head, {-rest.x(), rest.y(), rest.z()});
    joints[next++] = draft.carried(head, rest);
  }
  for (const SideBone bone : {SideBone::kUpperArm, SideBone::kForearm, SideBone::kHand,
                              SideBone::kThigh, SideBone::kShank, SideBone::kFoot}) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      joints[next++] = draft.joint[static_cast<std::size_t>(boneIndex(bone, side))];
    }
  }
  return joints;
}

}  // namespace

ArmPosture armTowards(const Vector3d& upper, const Vector3d& fore) {
  const Vector3d along = armAxis();
  const Vector3d back = backAxis();
  const Quaterniond swing = Quaterniond::FromTwoVectors(along, upper.normalized());
  const AngleAxisd turn(swing);
  const Vector3d v = turn.axis() * turn.angle();
  const Vector3d local = swing.conjugate() * fore.normalized();
  ArmPosture arm;
  arm.swing_forward = v.dot(back);
  arm.swing_up = -v.y();
  arm.elbow = std::acos(std::clamp(local.dot(along), -1.0, 1.0));
  arm.twist = arm.elbow > 0.02 ? std::atan2(local.dot(back), local.y()) : 0.0;
  return arm;
}

Vector3d PosedSkeleton::heldBall(Side side, double radius_m) const {
  // Scaled like the body; the ball's own radius is not.
  const auto& hand = bones[static_cast<std::size_t>(boneIndex(SideBone::kHand, side))];
  const double scale = hand.linear().col(0).norm();
  Vector3d palm = restJoint(SideBone::kHand) + armAxis() * 0.085 - backAxis() * 0.018 +
                  Vector3d::UnitY() * 0.006;
  Vector3d out = -backAxis() + armAxis() * 0.25;
  if (side == Side::kLeft) {
    palm.x() = -palm.x();
    out.x() = -out.x();
  }
  return hand * palm + (hand.linear() * out.normalized()) * (radius_m / scale);
}

PosedSkeleton poseSkeleton(const Posture& posture, double height_m) {
  Draft draft;
  const int pelvis = boneIndex(MidBone::kPelvis);
  const int spine = boneIndex(MidBone::kSpine);
  const int chest = boneIndex(MidBone::kChest);
  const int neck = boneIndex(MidBone::kNeck);
  const Matrix3d pelvis_turn =
      aboutZ(posture.heading) * aboutX(-posture.pelvis_bend) * aboutY(posture.pelvis_side);
  Vector3d root = posture.pelvis;
  root.z() = reachableHeight(posture, pelvis_turn);
  draft.place(pelvis, root, pelvis_turn);
  draft.attach(spine, draft.of(pelvis) *
                          trunkPart(posture.spine_bend, posture.spine_side, posture.spine_turn));
  draft.attach(chest, draft.of(spine) *
                          trunkPart(posture.chest_bend, posture.chest_side, posture.chest_turn));
  draft.attach(neck, draft.of(chest) * trunkPart(0.45 * posture.head_bend, 0.45 * posture.head_side,
                                                 0.45 * posture.head_turn));
  draft.attach(boneIndex(MidBone::kHead),
               draft.of(neck) * trunkPart(0.55 * posture.head_bend, 0.55 * posture.head_side,
                                          0.55 * posture.head_turn));
  for (const Side side : kSides) {
    const auto s = static_cast<std::size_t>(side);
    poseArm(posture.arms[s], side, draft);
    poseLeg(posture.feet[s], posture.knee_out[s], side, draft);
  }

  const double scale = height_m / kRestHeight_m;
  PosedSkeleton posed;
  for (std::size_t b = 0; b < kBones; ++b) {
    auto& bone = posed.bones[b];
    bone.linear() = scale * draft.turn[b];
    bone.translation() = scale * (draft.joint[b] - draft.turn[b] * restJoint(static_cast<int>(b)));
    bone.makeAffine();
  }
  posed.joints = cocoJoints(draft);
  for (auto& joint : posed.joints) joint *= scale;
  return posed;
}

}  // namespace emulator::studio
