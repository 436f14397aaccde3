#include "hal/emulated/studio/athlete/anatomy.h"

#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {
namespace {

Point joint(SideBone bone) {
  return restSkeleton()[static_cast<std::size_t>(boneIndex(bone, Side::kRight))].joint;
}
Point tip(SideBone bone) {
  return restSkeleton()[static_cast<std::size_t>(boneIndex(bone, Side::kRight))].tip;
}

struct Box {
  Point low, high;
};

float distanceToBox(const Point& p, const Box& box) {
  return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0F).norm();
}

/// @p shape blended into @p sum, evaluated only where it can matter.
template <typename Shape>
float blendNear(float sum, const Point& p, const Box& box, float blend, Shape shape) {
  return distanceToBox(p, box) > sum + blend ? sum : smoothUnion(sum, shape(), blend);
}

std::vector<Section> thicker(std::vector<Section> sections, float factor) {
  for (auto& s : sections) {
    s.side *= factor;
    s.front *= factor;
    s.back *= factor;
  }
  return sections;
}

std::vector<Section> trunkSections(float girth, bool female) {
  // Heights over the floor become fractions of the axis below.
  std::vector<Section> s = {
      {0.840F, 0.128F, 0.085F, 0.090F, 0.000F},  {0.900F, 0.166F, 0.105F, 0.122F, -0.005F},
      {0.950F, 0.173F, 0.108F, 0.128F, -0.005F}, {1.000F, 0.166F, 0.108F, 0.112F, -0.005F},
      {1.060F, 0.152F, 0.106F, 0.092F, -0.004F}, {1.120F, 0.145F, 0.104F, 0.086F, -0.004F},
      {1.200F, 0.152F, 0.108F, 0.094F, -0.008F}, {1.280F, 0.163F, 0.115F, 0.106F, -0.012F},
      {1.350F, 0.171F, 0.116F, 0.116F, -0.014F}, {1.400F, 0.168F, 0.105F, 0.118F, -0.018F},
      {1.440F, 0.150F, 0.084F, 0.106F, -0.022F}, {1.475F, 0.112F, 0.066F, 0.084F, -0.026F},
      {1.505F, 0.072F, 0.052F, 0.064F, -0.030F}};
  for (auto& x : s) {
    const float belly = std::exp(-std::pow((x.t - 1.10F) / 0.10F, 2.0F));
    const float hips = std::exp(-std::pow((x.t - 0.93F) / 0.09F, 2.0F));
    const float chest = std::exp(-std::pow((x.t - 1.36F) / 0.12F, 2.0F));
    const float g = 1 + 0.07F * girth + 0.13F * girth * belly;
    x.side *= g * (female ? 1 + 0.05F * hips - 0.09F * chest - 0.06F * belly : 1.0F);
    x.front *= g * (1 + 0.10F * std::max(girth, 0.0F) * belly) * (female ? 1 - 0.07F * chest : 1);
    x.back *= g * (female ? 1 + 0.05F * hips - 0.06F * chest : 1);
  }
  const float low = s.front().t;
  const float length = s.back().t - low;
  for (auto& x : s) x.t = (x.t - low) / length;
  return s;
}

}  // namespace

Anatomy::Anatomy(const BodyShape& shape)
    : girth_(static_cast<float>(std::clamp(shape.build, -1.0, 1.0))),
      female_(shape.sex == Sex::kFemale) {
  using enum SideBone;
  const Point forward = Point::UnitY();
  const float limb = (1 + 0.09F * girth_) * (female_ ? 0.90F : 1.0F);

  trunk_.emplace_back(Point{0, 0, 0.84F}, Point{0, 0, 1.505F}, forward, 0.03F,
                      trunkSections(girth_, female_));

  const float n = (female_ ? 0.87F : 1.0F) * (1 + 0.06F * girth_);
  neck_.emplace_back(Point{0, -0.040F, 1.455F}, Point{0, -0.006F, 1.640F}, forward, 0.01F,
                     thicker({{0.0F, 0.080F, 0.062F, 0.072F},
                              {0.25F, 0.064F, 0.054F, 0.062F},
                              {0.5F, 0.057F, 0.051F, 0.056F},
                              {0.75F, 0.056F, 0.050F, 0.058F},
                              {1.0F, 0.056F, 0.046F, 0.062F}},
                             n));

  const float jaw = female_ ? 0.87F : 1.0F;
  const std::vector<Section> face = {{0.000F, 0.022F * jaw, 0.030F, 0.030F, 0.052F},
                                     {0.075F, 0.037F * jaw, 0.041F, 0.048F, 0.048F},
                                     {0.165F, 0.047F * jaw, 0.048F, 0.060F, 0.042F},
                                     {0.270F, 0.0535F * jaw, 0.058F, 0.064F, 0.035F},
                                     {0.390F, 0.0585F * jaw, 0.068F, 0.072F, 0.027F},
                                     {0.510F, 0.0635F, 0.076F, 0.082F, 0.018F},
                                     {0.630F, 0.0675F, 0.080F, 0.090F, 0.011F},
                                     {0.760F, 0.0690F, 0.085F, 0.095F, 0.005F},
                                     {0.880F, 0.0715F, 0.0915F, 0.095F, 0.001F},
                                     {1.000F, 0.0725F, 0.090F, 0.098F, -0.002F}};
  face_.emplace_back(Point{0, 0, 1.574F}, Point{0, 0, 1.716F}, forward, 0.012F, face);

  // The arm's cross-sections: side lies in the plane of the arm and the vertical.
  arm_.emplace_back(joint(kUpperArm), joint(kForearm), forward, 0.02F,
                    thicker({{0.00F, 0.049F, 0.052F, 0.052F},
                             {0.18F, 0.050F, 0.049F, 0.052F},
                             {0.40F, 0.047F, 0.049F, 0.050F},
                             {0.60F, 0.043F, 0.049F, 0.046F},
                             {0.80F, 0.040F, 0.042F, 0.041F},
                             {0.93F, 0.042F, 0.036F, 0.039F},
                             {1.00F, 0.042F, 0.035F, 0.038F}},
                            limb));
  arm_.emplace_back(joint(kForearm), joint(kHand), forward, 0.01F,
                    thicker({{0.00F, 0.041F, 0.035F, 0.038F},
                             {0.12F, 0.043F, 0.042F, 0.038F},
                             {0.28F, 0.043F, 0.045F, 0.037F},
                             {0.50F, 0.037F, 0.039F, 0.034F},
                             {0.75F, 0.0285F, 0.030F, 0.029F},
                             {0.92F, 0.0225F, 0.0275F, 0.0275F},
                             {1.00F, 0.0215F, 0.0280F, 0.0280F}},
                            limb));
  const float h = female_ ? 0.90F : 1.0F;
  palm_.emplace_back(joint(kHand), joint(kHand) + restArmDirection() * 0.088F, forward, 0.008F,
                     thicker({{0.00F, 0.0205F, 0.027F, 0.027F},
                              {0.20F, 0.0195F, 0.031F, 0.030F},
                              {0.50F, 0.0175F, 0.038F, 0.036F},
                              {0.80F, 0.0150F, 0.041F, 0.039F},
                              {1.00F, 0.0125F, 0.040F, 0.038F}},
                             h));
  for (const SideBone bone : {kIndex1, kMiddle1, kRing1, kLittle1}) {
    const float r = (bone == kLittle1 ? 0.0078F : 0.0092F) * h;
    const auto second = static_cast<SideBone>(static_cast<int>(bone) + 1);
    fingers_.push_back({joint(bone) - restArmDirection() * 0.02F, tip(bone), r * 1.12F, r});
    fingers_.push_back({joint(second), tip(second), r, r * 0.84F});
  }
  fingers_.push_back({joint(kHand) + restArmDirection() * 0.015F + forward * 0.012F, tip(kThumb1),
                      0.0165F * h, 0.0112F * h});
  fingers_.push_back({joint(kThumb2), tip(kThumb2), 0.0112F * h, 0.0090F * h});

  const float thigh = limb * (female_ ? 1.10F : 1.0F);
  leg_.emplace_back(joint(kThigh) + Point{0.006F, 0, 0}, joint(kShank), forward, 0.03F,
                    thicker({{0.00F, 0.086F, 0.086F, 0.098F},
                             {0.20F, 0.083F, 0.088F, 0.088F},
                             {0.45F, 0.074F, 0.082F, 0.076F},
                             {0.70F, 0.063F, 0.068F, 0.064F},
                             {0.88F, 0.053F, 0.056F, 0.055F},
                             {1.00F, 0.048F, 0.051F, 0.050F}},
                            thigh));
  leg_.emplace_back(joint(kShank), joint(kFoot), forward, 0.02F,
                    thicker({{0.00F, 0.047F, 0.049F, 0.048F},
                             {0.10F, 0.048F, 0.047F, 0.054F},
                             {0.28F, 0.055F, 0.047F, 0.071F},
                             {0.45F, 0.051F, 0.044F, 0.064F},
                             {0.65F, 0.041F, 0.038F, 0.047F},
                             {0.85F, 0.034F, 0.033F, 0.037F},
                             {1.00F, 0.036F, 0.036F, 0.040F}},
                            limb));
  // From the heel to the toes; the section's front is up.
  foot_.emplace_back(Point{0.112F, -0.062F, 0.036F}, Point{0.118F, 0.166F, 0.030F}, Point::UnitZ(),
                     0.022F,
                     std::vector<Section>{{0.00F, 0.032F, 0.058F, 0.034F},
                                          {0.18F, 0.034F, 0.066F, 0.034F},
                                          {0.42F, 0.037F, 0.054F, 0.033F},
                                          {0.70F, 0.046F, 0.030F, 0.028F},
                                          {0.90F, 0.043F, 0.018F, 0.026F},
                                          {1.00F, 0.034F, 0.012F, 0.024F}});
}

float Anatomy::trunk(const Point& p) const {
  const Point q{std::abs(p.x()), p.y(), p.z()};
  float d = trunk_.front().distance(q);
  const float g = 1 + 0.07F * girth_;
  // Latissimus, pectoral, shoulder blade, trapezius, buttock.
  d = smoothUnion(d, ellipsoid(q, {0.118F, -0.040F, 1.345F}, Point{0.060F, 0.070F, 0.125F} * g),
                  0.05F);
  if (female_) {
    d = smoothUnion(d, ellipsoid(q, {0.078F, 0.072F, 1.312F}, Point{0.060F, 0.060F, 0.060F} * g),
                    0.035F);
  } else {
    d = smoothUnion(d, ellipsoid(q, {0.085F, 0.064F, 1.365F}, Point{0.085F, 0.034F, 0.060F} * g),
                    0.04F);
  }
  d = smoothUnion(d, ellipsoid(q, {0.095F, -0.105F, 1.37F}, Point{0.065F, 0.030F, 0.085F}), 0.05F);
  const float slope = female_ ? 0.90F : 1.0F;
  d = smoothUnion(d,
                  capsule(q, {0.025F, -0.045F, 1.520F}, {0.150F, -0.035F, 1.462F}, 0.036F * slope,
                          0.038F * slope),
                  0.06F);
  d = smoothUnion(d, ellipsoid(q, {0.078F, -0.070F, 0.915F}, Point{0.085F, 0.082F, 0.090F} * g),
                  0.04F);
  return d;
}

float Anatomy::hand(const Point& p) const {
  float d = palm_.front().distance(p);
  // The ball of the thumb and the heel of the hand.
  d = smoothUnion(
      d, capsule(p, fingers_[8].a, fingers_[8].b, fingers_[8].radius_a, fingers_[8].radius_b),
      0.018F);
  d = smoothUnion(
      d, capsule(p, fingers_[9].a, fingers_[9].b, fingers_[9].radius_a, fingers_[9].radius_b),
      0.006F);
  // Fingers flow into the palm and into their next phalanx, not into each other.
  float fingers = 1;
  for (std::size_t i = 0; i < 8; i += 2) {
    const auto& first = fingers_[i];
    const auto& second = fingers_[i + 1];
    const float finger =
        smoothUnion(capsule(p, first.a, first.b, first.radius_a, first.radius_b),
                    capsule(p, second.a, second.b, second.radius_a, second.radius_b), 0.006F);
    fingers = smoothUnion(fingers, finger, 0.003F);
  }
  return smoothUnion(d, fingers, 0.012F);
}

float Anatomy::arm(const Point& p) const {
  using enum SideBone;
  const Point q{std::abs(p.x()), p.y(), p.z()};
  const float limb = (1 + 0.09F * girth_) * (female_ ? 0.86F : 1.0F);
  float d = smoothUnion(arm_[0].distance(q), arm_[1].distance(q), 0.03F);
  const Point along = restArmDirection();
  // Deltoid, biceps, triceps; the point of the elbow.
  d = smoothUnion(d,
                  ellipsoid(q, joint(kUpperArm) + along * 0.040F + Point{0, 0, 0.004F},
                            Point{0.082F, 0.054F, 0.049F} * limb),
                  0.05F);
  d = smoothUnion(d,
                  ellipsoid(q, joint(kUpperArm) + along * 0.185F + Point{0, 0.016F, 0},
                            Point{0.075F, 0.034F, 0.036F} * limb),
                  0.03F);
  d = smoothUnion(d,
                  ellipsoid(q, joint(kUpperArm) + along * 0.155F + Point{0, -0.020F, 0},
                            Point{0.085F, 0.035F, 0.040F} * limb),
                  0.03F);
  d = smoothUnion(d, ellipsoid(q, joint(kForearm) + Point{0, -0.030F, 0}, {0.020F, 0.012F, 0.018F}),
                  0.025F);
  const Point wrist = joint(kHand);
  const Box hand_box{wrist - Point{0.02F, 0.07F, 0.13F}, wrist + Point{0.22F, 0.11F, 0.06F}};
  return blendNear(d, q, hand_box, 0.03F, [&] { return hand(q); });
}

float Anatomy::leg(const Point& p) const {
  using enum SideBone;
  const Point q{std::abs(p.x()), p.y(), p.z()};
  float d = smoothUnion(leg_[0].distance(q), leg_[1].distance(q), 0.04F);
  // Kneecap, vastus above it on the inside and outside, the calf's inner head, ankle bones.
  d = smoothUnion(
      d, ellipsoid(q, joint(kShank) + Point{0, 0.042F, 0.012F}, {0.026F, 0.018F, 0.032F}), 0.025F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kShank) + Point{-0.030F, 0.024F, 0.085F}, {0.030F, 0.034F, 0.060F}),
      0.035F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kShank) + Point{0.028F, 0.026F, 0.125F}, {0.034F, 0.040F, 0.100F}),
      0.035F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kShank) + Point{-0.018F, -0.038F, -0.115F}, {0.032F, 0.034F, 0.080F}),
      0.03F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kShank) + Point{0.024F, -0.034F, -0.100F}, {0.028F, 0.030F, 0.070F}),
      0.03F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kFoot) + Point{-0.028F, 0.004F, 0.002F}, {0.016F, 0.016F, 0.018F}),
      0.02F);
  d = smoothUnion(
      d, ellipsoid(q, joint(kFoot) + Point{0.028F, -0.004F, -0.006F}, {0.015F, 0.016F, 0.018F}),
      0.02F);
  return smoothUnion(d, foot(p), 0.03F);
}

float Anatomy::foot(const Point& p) const {
  return foot_.front().distance({std::abs(p.x()), p.y(), p.z()});
}

float Anatomy::skin(const Point& p) const {
  const Point q{std::abs(p.x()), p.y(), p.z()};
  float d = trunk(q);
  d = blendNear(d, q, {{0.0F, -0.14F, -0.01F}, {0.26F, 0.20F, 1.06F}}, 0.045F,
                [&] { return leg(q); });
  d = blendNear(d, q, {{0.08F, -0.12F, 1.02F}, {1.00F, 0.12F, 1.56F}}, 0.045F,
                [&] { return arm(q); });
  return blendNear(d, q, {{0.0F, -0.13F, 1.43F}, {0.11F, 0.14F, 1.81F}}, 0.04F,
                   [&] { return head(q); });
}

}  // namespace emulator::studio
