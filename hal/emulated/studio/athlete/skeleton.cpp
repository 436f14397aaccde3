#include "hal/emulated/studio/athlete/skeleton.h"

#include <cmath>

namespace emulator::studio {
namespace {

using Eigen::Vector3f;

constexpr float kRestArmDrop = 0.42F;  // rad
constexpr float kUpperArm_m = 0.300F;
constexpr float kForearm_m = 0.262F;

struct SideDraft {
  SideBone bone;
  std::string_view right_name;
  std::string_view left_name;
  int parent;  // kSideBones and more: a bone of the middle
  Vector3f joint;
  Vector3f tip;
};

constexpr int kFromMid = kSideBones;
constexpr int of(SideBone bone) {
  return static_cast<int>(bone);
}
constexpr int of(MidBone bone) {
  return kFromMid + static_cast<int>(bone);
}

/// Along the arm, across it towards the thumb, and out of the back of the hand.
Vector3f inHand(float along, float thumbwards, float back) {
  const Vector3f arm = restArmDirection();
  const Vector3f up{std::sin(kRestArmDrop), 0, std::cos(kRestArmDrop)};
  const Vector3f shoulder{0.180F, -0.015F, 1.452F};
  return shoulder + arm * (kUpperArm_m + kForearm_m + along) + Vector3f::UnitY() * thumbwards +
         up * back;
}

std::vector<SideDraft> rightSide() {
  const Vector3f arm = restArmDirection();
  const Vector3f shoulder{0.180F, -0.015F, 1.452F};
  const Vector3f elbow = shoulder + arm * kUpperArm_m;
  const Vector3f wrist = elbow + arm * kForearm_m;
  const Vector3f mid_arm = shoulder + arm * (0.5F * kUpperArm_m);
  const Vector3f mid_forearm = elbow + arm * (0.55F * kForearm_m);
  const Vector3f hip{0.090F, 0.000F, 0.935F};
  const Vector3f knee{0.104F, 0.006F, 0.498F};
  const Vector3f ankle{0.112F, -0.022F, 0.088F};
  const Vector3f ball{0.116F, 0.110F, 0.028F};
  using enum SideBone;
  std::vector<SideDraft> draft = {
      {kClavicle, "clavicle_r", "clavicle_l", of(MidBone::kChest), {0.02F, 0.03F, 1.46F}, shoulder},
      {kShoulderHalf, "shoulder_half_r", "shoulder_half_l", of(kClavicle), shoulder,
       shoulder + arm * 0.03F},
      {kUpperArm, "upper_arm_r", "upper_arm_l", of(kClavicle), shoulder, mid_arm},
      {kUpperArmLow, "upper_arm_low_r", "upper_arm_low_l", of(kUpperArm), mid_arm, elbow},
      {kElbowHalf, "elbow_half_r", "elbow_half_l", of(kUpperArmLow), elbow, elbow + arm * 0.01F},
      {kForearm, "forearm_r", "forearm_l", of(kUpperArmLow), elbow, mid_forearm},
      {kForearmLow, "forearm_low_r", "forearm_low_l", of(kForearm), mid_forearm, wrist},
      {kHand, "hand_r", "hand_l", of(kForearmLow), wrist, inHand(0.085F, 0, 0)},
      {kThumb1, "thumb1_r", "thumb1_l", of(kHand), inHand(0.028F, 0.026F, -0.010F),
       inHand(0.068F, 0.052F, -0.018F)},
      {kThumb2, "thumb2_r", "thumb2_l", of(kThumb1), inHand(0.068F, 0.052F, -0.018F),
       inHand(0.108F, 0.068F, -0.024F)},
  };
  struct Finger {
    SideBone first;
    std::string_view names[4];
    float across;
    float root;
    float length;
  };
  const std::array<Finger, 4> fingers{{
      {kIndex1, {"index1_r", "index1_l", "index2_r", "index2_l"}, 0.030F, 0.090F, 0.078F},
      {kMiddle1, {"middle1_r", "middle1_l", "middle2_r", "middle2_l"}, 0.009F, 0.093F, 0.086F},
      {kRing1, {"ring1_r", "ring1_l", "ring2_r", "ring2_l"}, -0.0115F, 0.089F, 0.079F},
      {kLittle1, {"little1_r", "little1_l", "little2_r", "little2_l"}, -0.030F, 0.081F, 0.062F},
  }};
  for (const auto& finger : fingers) {
    const float spread = finger.across * 0.18F;
    const Vector3f root = inHand(finger.root, finger.across, -0.001F);
    const Vector3f middle =
        inHand(finger.root + 0.48F * finger.length, finger.across + spread * 0.5F, -0.006F);
    const Vector3f end = inHand(finger.root + finger.length, finger.across + spread, -0.019F);
    const auto second = static_cast<SideBone>(of(finger.first) + 1);
    draft.push_back({finger.first, finger.names[0], finger.names[1], of(kHand), root, middle});
    draft.push_back({second, finger.names[2], finger.names[3], of(finger.first), middle, end});
  }
  const auto pelvis = of(MidBone::kPelvis);
  draft.push_back(
      {kHipHalf, "hip_half_r", "hip_half_l", pelvis, hip, hip - Vector3f::UnitZ() * 0.02F});
  draft.push_back({kThigh, "thigh_r", "thigh_l", pelvis, hip, knee});
  draft.push_back({kKneeHalf, "knee_half_r", "knee_half_l", of(kThigh), knee,
                   knee - Vector3f::UnitZ() * 0.01F});
  draft.push_back({kShank, "shank_r", "shank_l", of(kThigh), knee, ankle});
  draft.push_back({kFoot, "foot_r", "foot_l", of(kShank), ankle, ball});
  draft.push_back({kToes, "toes_r", "toes_l", of(kFoot), ball, {0.118F, 0.175F, 0.02F}});
  return draft;
}

std::array<Bone, kBones> makeSkeleton() {
  std::array<Bone, kBones> bones;
  const auto mid = [&](MidBone bone) -> Bone& {
    return bones[static_cast<std::size_t>(boneIndex(bone))];
  };
  mid(MidBone::kPelvis) = {"pelvis", -1, {0, 0.0F, 0.965F}, {0, -0.005F, 1.06F}};
  mid(MidBone::kSpine) = {
      "spine", boneIndex(MidBone::kPelvis), {0, -0.012F, 1.065F}, {0, -0.015F, 1.20F}};
  mid(MidBone::kChest) = {
      "chest", boneIndex(MidBone::kSpine), {0, -0.018F, 1.215F}, {0, -0.02F, 1.46F}};
  mid(MidBone::kNeck) = {
      "neck", boneIndex(MidBone::kChest), {0, -0.032F, 1.500F}, {0, -0.012F, 1.585F}};
  mid(MidBone::kHead) = {"head", boneIndex(MidBone::kNeck), {0, -0.010F, 1.600F}, {0, 0.0F, 1.74F}};
  for (const Side side : kSides) {
    const Vector3f mirror{side == Side::kRight ? 1.0F : -1.0F, 1, 1};
    for (const auto& draft : rightSide()) {
      const int parent = draft.parent >= kFromMid
                             ? draft.parent - kFromMid
                             : boneIndex(static_cast<SideBone>(draft.parent), side);
      bones[static_cast<std::size_t>(boneIndex(draft.bone, side))] = {
          side == Side::kRight ? draft.right_name : draft.left_name, parent,
          draft.joint.cwiseProduct(mirror), draft.tip.cwiseProduct(mirror)};
    }
  }
  return bones;
}

}  // namespace

Vector3f restArmDirection() {
  return {std::cos(kRestArmDrop), 0, -std::sin(kRestArmDrop)};
}

const std::array<Bone, kBones>& restSkeleton() {
  static const auto kSkeleton = makeSkeleton();
  return kSkeleton;
}

}  // namespace emulator::studio
