#include "hal/emulated/studio/athlete/draw_shape.h"

#include <algorithm>
#include <array>

#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

using Eigen::Vector3f;

Vector3f drawSkin(Random& random) {
  // From light to dark, with a little less red in between.
  const float t = random.uniform(0, 1);
  const Vector3f light{0.66F, 0.42F, 0.30F};
  const Vector3f dark{0.13F, 0.065F, 0.04F};
  return light + (dark - light) * t * (0.55F + 0.45F * t);
}

Vector3f drawHair(Random& random, const Vector3f& skin) {
  static const std::array<Vector3f, 4> kHair{
      Vector3f{0.012F, 0.010F, 0.009F}, Vector3f{0.045F, 0.026F, 0.015F},
      Vector3f{0.13F, 0.075F, 0.035F}, Vector3f{0.34F, 0.23F, 0.11F}};
  const std::size_t choices = skin.x() < 0.35F ? 2 : kHair.size();
  return kHair[random.next() % choices] * random.uniform(0.85F, 1.15F);
}

Vector3f drawCloth(Random& random) {
  static const std::array<Vector3f, 8> kCloth{
      Vector3f{0.55F, 0.035F, 0.04F}, Vector3f{0.03F, 0.09F, 0.38F},  Vector3f{0.04F, 0.26F, 0.09F},
      Vector3f{0.70F, 0.70F, 0.68F},  Vector3f{0.03F, 0.03F, 0.035F}, Vector3f{0.75F, 0.42F, 0.03F},
      Vector3f{0.24F, 0.25F, 0.27F},  Vector3f{0.05F, 0.30F, 0.38F}};
  return kCloth[random.next() % kCloth.size()];
}

}  // namespace

BodyShape drawShape(std::uint64_t seed) {
  Random random(seed);
  BodyShape shape;
  shape.seed = seed;
  shape.sex = random.unit() < 0.5 ? Sex::kMale : Sex::kFemale;
  const bool female = shape.sex == Sex::kFemale;
  shape.height_m = std::clamp((female ? 1.69 : 1.82) + 0.065 * random.normal(), 1.55, 2.02);
  shape.build = std::clamp(0.4 * random.normal(), -0.9, 0.9);
  const double cut = random.unit();
  shape.hair_cut = female ? (cut < 0.7 ? HairCut::kTail : HairCut::kFull)
                          : (cut < 0.75 ? HairCut::kShort : HairCut::kFull);
  shape.skin = drawSkin(random);
  shape.hair = drawHair(random, shape.skin);
  static const std::array<Vector3f, 3> kEyes{
      Vector3f{0.10F, 0.16F, 0.20F}, Vector3f{0.09F, 0.05F, 0.02F}, Vector3f{0.10F, 0.13F, 0.06F}};
  shape.eye = shape.skin.x() < 0.35F ? kEyes[1] : kEyes[random.next() % kEyes.size()];
  shape.shirt = drawCloth(random);
  const float brightness = shape.shirt.sum() / 3;
  shape.shirt_trim =
      brightness > 0.45F ? Vector3f{0.04F, 0.05F, 0.09F} : Vector3f{0.80F, 0.80F, 0.80F};
  shape.shorts = random.unit() < 0.6 ? Vector3f{0.02F, 0.022F, 0.03F} : drawCloth(random) * 0.6F;
  shape.shoe = drawCloth(random);
  shape.number = 1 + static_cast<int>(random.next() % 98);
  shape.left_handed = random.unit() < 0.12;
  return shape;
}

}  // namespace emulator::studio
