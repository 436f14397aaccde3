#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace emulator::studio {

/// Standing height of the body at rest. A person of another height is this body, scaled by the
/// matrices of its bones, so that textures and weights are the same for everybody.
inline constexpr double kRestHeight_m = 1.80;

/// Bones of one side, in the order of their numbers. "Half" bones turn half as far as the joint
/// they sit in: with them linear blend skinning keeps the volume of a bent joint. "Low" bones
/// carry the twist of the limb that "upper" ones do not.
enum class SideBone : std::uint8_t {
  kClavicle,
  kShoulderHalf,
  kUpperArm,
  kUpperArmLow,
  kElbowHalf,
  kForearm,
  kForearmLow,
  kHand,
  kThumb1,
  kThumb2,
  kIndex1,
  kIndex2,
  kMiddle1,
  kMiddle2,
  kRing1,
  kRing2,
  kLittle1,
  kLittle2,
  kHipHalf,
  kThigh,
  kKneeHalf,
  kShank,
  kFoot,
  kToes,
  kCount
};

enum class MidBone : std::uint8_t { kPelvis, kSpine, kChest, kNeck, kHead, kCount };

enum class Side : std::uint8_t { kRight, kLeft };
inline constexpr std::array<Side, 2> kSides{Side::kRight, Side::kLeft};

inline constexpr int kMidBones = static_cast<int>(MidBone::kCount);
inline constexpr int kSideBones = static_cast<int>(SideBone::kCount);
inline constexpr int kBones = kMidBones + 2 * kSideBones;

constexpr int boneIndex(MidBone bone) {
  return static_cast<int>(bone);
}
constexpr int boneIndex(SideBone bone, Side side) {
  return kMidBones + static_cast<int>(side) * kSideBones + static_cast<int>(bone);
}

/// A bone at rest: axes along the body's (x right, y forward, z up), metres at kRestHeight_m,
/// origin on the floor between the feet. `tip` is where its flesh ends.
struct Bone {
  std::string_view name;
  int parent = -1;
  Eigen::Vector3f joint = Eigen::Vector3f::Zero();
  Eigen::Vector3f tip = Eigen::Vector3f::Zero();
};

/// The skeleton of an adult at rest: upright, arms raised to kRestArmDrop below the horizontal,
/// thumbs forward. Segment lengths after Drillis & Contini as fractions of the body height.
[[nodiscard]] const std::array<Bone, kBones>& restSkeleton();

/// Of the arm, right side, at rest.
[[nodiscard]] Eigen::Vector3f restArmDirection();

}  // namespace emulator::studio
