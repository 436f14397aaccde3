#include "hal/emulated/studio/athlete/tailor.h"

#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/noise.h"
#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {
namespace {

Point joint(SideBone bone) {
  return restSkeleton()[static_cast<std::size_t>(boneIndex(bone, Side::kRight))].joint;
}

std::vector<Section> grown(std::vector<Section> sections, float factor) {
  for (auto& s : sections) {
    s.side *= factor;
    s.front *= factor;
    s.back *= factor;
  }
  return sections;
}

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

Point mirrored(const Point& p) {
  return {std::abs(p.x()), p.y(), p.z()};
}

constexpr float kShirtHem_m = 0.838F;
constexpr float kShortsHem_m = 0.600F;
constexpr float kWaistband_m = 1.030F;

/// Height of the hair's edge over y, forehead to nape.
float hairLine(float y) {
  struct Knot {
    float y, z;
  };
  static constexpr std::array<Knot, 10> kLine{{{-0.120F, 1.600F},
                                               {-0.080F, 1.605F},
                                               {-0.050F, 1.628F},
                                               {-0.030F, 1.682F},
                                               {-0.006F, 1.704F},
                                               {0.010F, 1.676F},
                                               {0.026F, 1.672F},
                                               {0.040F, 1.722F},
                                               {0.062F, 1.752F},
                                               {0.110F, 1.762F}}};
  if (y <= kLine.front().y) return kLine.front().z;
  for (std::size_t i = 1; i < kLine.size(); ++i) {
    if (y > kLine[i].y) continue;
    const float t = smoothStep(kLine[i - 1].y, kLine[i].y, y);
    return kLine[i - 1].z + (kLine[i].z - kLine[i - 1].z) * t;
  }
  return kLine.back().z;
}

}  // namespace

Tailor::Tailor(const BodyShape& shape, const Anatomy& anatomy)
    : anatomy_(anatomy),
      hair_cut_(shape.hair_cut),
      seed_(static_cast<std::uint32_t>(shape.seed * 2654435761U)),
      cloth_m_(0.012F * static_cast<float>(std::max(shape.cell_scale, 1.0))) {
  const Point forward = Point::UnitY();
  const float g = (1 + 0.10F * anatomy.girth()) * (anatomy.female() ? 0.94F : 1.0F);
  const Point top{0, 0, 1.50F};
  const Point hem{0, 0, kShirtHem_m - 0.05F};
  const std::vector<Section> shirt = {
      {0.00F, 0.196F, 0.128F, 0.150F, 0.000F},  {0.20F, 0.192F, 0.130F, 0.148F, -0.002F},
      {0.38F, 0.174F, 0.132F, 0.118F, -0.004F}, {0.55F, 0.174F, 0.134F, 0.114F, -0.008F},
      {0.72F, 0.182F, 0.136F, 0.124F, -0.012F}, {0.85F, 0.176F, 0.122F, 0.126F, -0.016F},
      {0.93F, 0.150F, 0.092F, 0.106F, -0.022F}, {1.00F, 0.088F, 0.060F, 0.076F, -0.030F}};
  shirt_.emplace_back(hem, top, forward, 0.01F, grown(shirt, g));

  const Point arm = restArmDirection();
  const Point shoulder = joint(SideBone::kUpperArm);
  const std::vector<Section> sleeve = {{0.00F, 0.054F, 0.058F, 0.060F},
                                       {0.30F, 0.062F, 0.062F, 0.064F},
                                       {0.60F, 0.067F, 0.064F, 0.064F},
                                       {1.00F, 0.070F, 0.066F, 0.066F}};
  const Point slack{0, 0, -0.006F};  // a sleeve hangs
  sleeve_.emplace_back(shoulder - arm * 0.02F, shoulder + arm * 0.235F + slack * 2, forward, 0.002F,
                       grown(sleeve, g));

  const std::vector<Section> seat = {{0.00F, 0.150F, 0.108F, 0.125F, 0.0F},
                                     {0.25F, 0.184F, 0.124F, 0.146F, 0.0F},
                                     {0.48F, 0.188F, 0.126F, 0.150F, 0.0F},
                                     {0.72F, 0.182F, 0.122F, 0.134F, 0.0F},
                                     {1.00F, 0.164F, 0.114F, 0.108F, 0.0F}};
  seat_.emplace_back(Point{0, 0, 0.79F}, Point{0, 0, kWaistband_m}, forward, 0.006F,
                     grown(seat, g));
  const std::vector<Section> leg = {{0.00F, 0.080F, 0.085F, 0.090F},
                                    {0.20F, 0.098F, 0.110F, 0.114F},
                                    {0.45F, 0.102F, 0.112F, 0.112F},
                                    {0.70F, 0.100F, 0.109F, 0.108F},
                                    {1.00F, 0.102F, 0.111F, 0.110F}};
  leg_.emplace_back(Point{0.098F, -0.004F, 0.93F}, Point{0.117F, 0.000F, kShortsHem_m - 0.04F},
                    forward, 0.004F, grown(leg, g));
}

float Tailor::folds(const Point& p, float scale_m) const {
  const Point q = p / scale_m;
  const Point warp{smoothNoise(q * 0.6F, seed_), smoothNoise(q * 0.6F, seed_ + 1),
                   smoothNoise(q * 0.6F, seed_ + 2)};
  const float wave = smoothNoise(q + warp * 0.9F, seed_ + 3);
  return 1 - 2 * std::sqrt(wave * wave + 0.02F);  // ridges
}

float Tailor::shirt(const Point& p) const {
  const Point q = mirrored(p);
  const float around = std::max(
      {q.x() - 0.46F, std::abs(q.y()) - 0.22F, kShirtHem_m - 0.03F - q.z(), q.z() - 1.60F});
  if (around > 0.06F) return around;
  // Along the sleeve; the flank lies before it.
  const float along =
      (q - joint(SideBone::kUpperArm)).dot(restArmDirection()) - 3 * std::max(1.22F - q.z(), 0.0F);

  const float flesh = smoothUnion(anatomy_.trunk(q), anatomy_.arm(q), 0.045F);
  float outside = smoothUnion(shirt_.front().distance(q), flesh - 0.006F, 0.02F);
  const float shorts = smoothUnion(seat_.front().distance(q), leg_.front().distance(q), 0.03F);
  outside = smoothUnion(outside, shorts - 0.010F, 0.03F);
  outside = smoothUnion(outside, sleeve_.front().distance(q), 0.045F);
  // Folds hang from the armpit and gather at the waist; the chest is stretched smooth.
  const float waist = smoothStep(1.30F, 1.05F, q.z());
  const float armpit = std::exp(-(q - Point{0.19F, 0, 1.36F}).squaredNorm() / 0.010F);
  const float lower = smoothStep(0.08F, 0.20F, along);
  const float depth = 0.0012F + 0.0048F * waist + 0.0040F * armpit + 0.0025F * lower;
  const Point stretched{p.x() * 1.5F, p.y() * 1.5F, (p.z() + 0.45F * std::abs(p.x())) * 0.75F};
  const Point on_sleeve{p.x() * 0.8F, p.y() * 1.4F, p.z() * 1.2F};
  const float crease = folds(stretched, 0.085F) * (1 - lower) + folds(on_sleeve, 0.06F) * lower;
  outside -= depth * (crease + 0.25F);
  outside = std::min(outside, flesh - 0.004F);

  // Collar, sleeve ends, hem.
  const float collar = (q.z() - 1.505F) * 0.93F + (q.y() + 0.055F) * 0.36F - 6 * q.x() * q.x();
  outside -= 0.0025F * smoothStep(0.020F, 0.014F, std::abs(collar + 0.008F));
  float d = smoothMeet(outside, collar, 0.004F);
  d = smoothMeet(d, along - 0.215F, 0.003F);
  const float hem = kShirtHem_m + 0.008F * folds(p, 0.12F) * 0.5F - q.z();
  d = smoothMeet(d, hem, 0.003F);
  const float openings = std::min(q.z() - kShirtHem_m - 0.06F, 0.16F - along);
  return smoothCut(d, std::max(outside + cloth_m_, openings), 0.004F);
}

float Tailor::shorts(const Point& p) const {
  const Point q = mirrored(p);
  const float around = std::max(
      {q.x() - 0.26F, std::abs(q.y()) - 0.22F, kShortsHem_m - 0.03F - q.z(), q.z() - 1.08F});
  if (around > 0.06F) return around;
  float outside = smoothUnion(seat_.front().distance(q), leg_.front().distance(q), 0.03F);
  const float lower = smoothStep(0.92F, 0.75F, q.z());
  const Point stretched{p.x() * 1.3F, p.y() * 1.3F, p.z() * 0.8F};
  outside -= (0.0015F + 0.0050F * lower) * (folds(stretched, 0.08F) + 0.25F);
  float d = smoothMeet(outside, kShortsHem_m - 0.02F * (q.x() - 0.1F) - q.z(), 0.003F);
  d = smoothMeet(d, q.z() - kWaistband_m, 0.003F);
  return smoothCut(d, std::max(outside + cloth_m_, q.z() - kShortsHem_m - 0.10F), 0.004F);
}

float Tailor::sock(const Point& p) const {
  const Point q = mirrored(p);
  if (q.z() > 0.30F) return q.z() - 0.24F;
  float d = anatomy_.leg(q) - 0.0032F;
  const float rib = smoothStep(0.165F, 0.175F, q.z());
  d -= rib * 0.0012F;
  return smoothMeet(d, q.z() - 0.200F, 0.003F);
}

float Tailor::shoe(const Point& p) const {
  const Point q = mirrored(p);
  if (q.z() > 0.20F) return q.z() - 0.16F;
  float d = anatomy_.foot(q) - 0.0085F;
  // Heel counter, tongue and padded collar.
  d = smoothUnion(d, ellipsoid(q, {0.112F, -0.048F, 0.072F}, {0.037F, 0.034F, 0.050F}), 0.03F);
  d = smoothUnion(d, capsule(q, {0.112F, 0.036F, 0.100F}, {0.116F, 0.095F, 0.062F}, 0.026F, 0.030F),
                  0.03F);
  const float opening = (q.z() - 0.105F) * 0.95F - (q.y() - 0.01F) * 0.22F;
  d = smoothMeet(d, opening, 0.008F);
  const float leg = anatomy_.leg(q) - 0.0030F;
  d = smoothCut(d, std::max(leg, 0.086F - q.z()), 0.005F);
  return std::max(d, 0.004F - q.z());
}

float Tailor::sole(const Point& p) const {
  const Point q = mirrored(p);
  const float outline = anatomy_.foot({q.x(), std::clamp(q.y(), -0.2F, 0.3F), 0.032F}) - 0.0115F;
  const float toe_spring = 0.010F * smoothStep(0.12F, 0.20F, q.y());
  const float heel = 0.006F * smoothStep(0.02F, -0.05F, q.y());
  const float low = -kSoleDepth_m + toe_spring;
  const float high = 0.015F + toe_spring + heel;
  const float slab = std::max(low - q.z(), q.z() - high);
  return smoothMeet(outline, slab, 0.006F);
}

float Tailor::hair(const Point& p) const {
  const float y = p.y();
  const float top = smoothStep(1.70F, 1.78F, p.z());
  const float front = smoothStep(0.0F, 0.08F, y);
  const bool tail = hair_cut_ == HairCut::kTail;
  float thick = 0.005F + 0.007F * top + 0.004F * top * front;
  if (hair_cut_ == HairCut::kFull) thick = 0.016F + 0.014F * top + 0.006F * front;
  if (tail) thick = 0.007F + 0.006F * top;

  float line = hairLine(y);
  if (hair_cut_ == HairCut::kFull) line -= 0.03F * smoothStep(0.03F, -0.03F, y);
  thick *= 0.35F + 0.65F * smoothStep(0.0F, tail ? 0.02F : 0.045F, p.z() - line);

  // Locks lie along the head: stretched noise, finer across.
  const float azimuth = std::atan2(p.x(), -y + 0.03F);
  const Point combed = tail ? Point{azimuth * 1.0F, p.z() * 60, y * 14}
                            : Point{p.x() * 75 + 4 * azimuth, y * 22, p.z() * 18};
  const float locks = smoothNoise(combed, seed_ + 7) + 0.5F * smoothNoise(combed * 2.1F, seed_ + 8);
  float d = anatomy_.cranium(p) - thick - 0.0022F * locks;

  line += 0.004F * smoothNoise(Point{p.x() * 60, y * 60, 0}, seed_ + 9);
  d = smoothMeet(d, (line - p.z()) * 0.75F, 0.012F);
  if (tail) {
    const Point root{0, -0.112F, 1.715F};
    const Point mid{0, -0.142F, 1.655F};
    const Point end{0, -0.138F, 1.520F};
    const float sway = 0.0025F * smoothNoise(Point{p.x() * 110, y * 110, p.z() * 14}, seed_ + 5);
    const float rope = smoothUnion(capsule(p, root, mid, 0.016F, 0.021F),
                                   capsule(p, mid, end, 0.021F, 0.007F), 0.03F);
    d = smoothUnion(d, rope - sway, 0.012F);
  }
  return d;
}

}  // namespace emulator::studio
