#include "hal/emulated/rig/mannequin.h"

#include <array>
#include <limits>

namespace emulator {
namespace {

constexpr Vec3 kSkin = {0.60f, 0.36f, 0.25f};
constexpr Vec3 kHair = {0.045f, 0.030f, 0.022f};
constexpr Vec3 kShirt = {0.62f, 0.08f, 0.035f};
constexpr Vec3 kShorts = {0.035f, 0.05f, 0.11f};
constexpr Vec3 kShoe = {0.72f, 0.73f, 0.74f};

/// A cone with rounded ends from @p a (radius ra) to @p b (radius rb).
struct Limb {
  Vec3 a;
  Vec3 b;
  float ra;
  float rb;
  Vec3 albedo;
};

// x: the figure's left is +x for a viewer at -y ... its own right; metres, feet on z = 0.
constexpr std::array kLimbs = {
    Limb{{0, -0.015f, 1.600f}, {0, 0, 1.660f}, 0.072f, 0.085f, kSkin},            // head
    Limb{{0, 0.020f, 1.650f}, {0, 0.004f, 1.674f}, 0.084f, 0.083f, kHair},        // hair
    Limb{{0, 0.01f, 1.43f}, {0, 0, 1.56f}, 0.056f, 0.052f, kSkin},                // neck
    Limb{{-0.14f, 0.01f, 1.38f}, {0.14f, 0.01f, 1.38f}, 0.080f, 0.080f, kShirt},  // shoulders
    Limb{{-0.07f, 0, 1.28f}, {0.07f, 0, 1.28f}, 0.112f, 0.112f, kShirt},          // chest
    Limb{{-0.05f, 0, 1.25f}, {-0.03f, 0, 1.03f}, 0.115f, 0.115f, kShirt},         // waist
    Limb{{0.05f, 0, 1.25f}, {0.03f, 0, 1.03f}, 0.115f, 0.115f, kShirt},
    Limb{{-0.065f, 0, 0.94f}, {0.065f, 0, 0.94f}, 0.120f, 0.120f, kShorts},  // pelvis
    Limb{{-0.185f, 0.01f, 1.385f}, {-0.27f, 0.04f, 1.25f}, 0.066f, 0.056f, kShirt},
    Limb{{-0.27f, 0.04f, 1.25f}, {-0.335f, 0.04f, 1.11f}, 0.046f, 0.040f, kSkin},
    Limb{{-0.335f, 0.04f, 1.11f}, {-0.34f, -0.14f, 0.95f}, 0.040f, 0.030f, kSkin},
    Limb{{-0.34f, -0.15f, 0.94f}, {-0.335f, -0.20f, 0.89f}, 0.036f, 0.028f, kSkin},
    Limb{{0.185f, 0.01f, 1.385f}, {0.28f, 0.03f, 1.26f}, 0.066f, 0.056f, kShirt},
    Limb{{0.28f, 0.03f, 1.26f}, {0.36f, 0.01f, 1.13f}, 0.046f, 0.040f, kSkin},
    Limb{{0.36f, 0.01f, 1.13f}, {0.35f, -0.19f, 1.00f}, 0.040f, 0.030f, kSkin},
    Limb{{0.35f, -0.20f, 0.99f}, {0.34f, -0.26f, 0.96f}, 0.036f, 0.028f, kSkin},
    Limb{{-0.10f, 0, 0.90f}, {-0.125f, -0.02f, 0.64f}, 0.102f, 0.088f, kShorts},
    Limb{{-0.125f, -0.02f, 0.64f}, {-0.14f, -0.03f, 0.49f}, 0.070f, 0.056f, kSkin},
    Limb{{-0.14f, -0.02f, 0.46f}, {-0.155f, 0.03f, 0.12f}, 0.060f, 0.038f, kSkin},
    Limb{{-0.155f, 0.045f, 0.052f}, {-0.175f, -0.13f, 0.040f}, 0.050f, 0.040f, kShoe},
    Limb{{0.10f, 0, 0.90f}, {0.135f, 0.03f, 0.64f}, 0.102f, 0.088f, kShorts},
    Limb{{0.135f, 0.03f, 0.64f}, {0.15f, 0.05f, 0.49f}, 0.070f, 0.056f, kSkin},
    Limb{{0.15f, 0.05f, 0.46f}, {0.165f, 0.16f, 0.12f}, 0.060f, 0.038f, kSkin},
    Limb{{0.165f, 0.175f, 0.052f}, {0.205f, 0.01f, 0.040f}, 0.050f, 0.040f, kShoe},
};

constexpr float kBlend_m = 0.025f;
constexpr Vec3 kCentre = {0, 0, 0.88f};
constexpr float kBoundingRadius_m = 1.0f;
constexpr float kHit_m = 0.0008f;
constexpr int kMaxSteps = 48;

float limbDistance(const Limb& limb, Vec3 p) {
  const Vec3 axis = limb.b - limb.a;
  const Vec3 from = p - limb.a;
  const float t = clamp01(dot(from, axis) / dot(axis, axis));
  return length(from - axis * t) - (limb.ra + (limb.rb - limb.ra) * t);
}

/// The limbs that lie within a margin of one ray: few of them, so that a step is cheap.
class NearLimbs {
 public:
  NearLimbs(Vec3 origin, Vec3 direction, float margin) {
    for (const Limb& limb : kLimbs) {
      const Vec3 middle = (limb.a + limb.b) * 0.5f;
      const float reach = length(limb.b - limb.a) * 0.5f + std::max(limb.ra, limb.rb) + margin;
      const Vec3 to = middle - origin;
      const float along = std::max(dot(to, direction), 0.0f);
      const Vec3 off = to - direction * along;
      if (dot(off, off) < reach * reach) limbs_[count_++] = &limb;
    }
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] float distance(Vec3 point) const;

 private:
  std::array<const Limb*, kLimbs.size()> limbs_;
  std::size_t count_ = 0;
};

/// Polynomial smooth minimum: distances closer than kBlend_m flow together.
float blend(float a, float b) {
  const float h = std::max(kBlend_m - std::abs(a - b), 0.0f) / kBlend_m;
  return std::min(a, b) - h * h * kBlend_m * 0.25f;
}

/// Entry and exit of a ray through the bounding sphere; empty when enter > leave.
struct Span {
  float enter;
  float leave;
};
Span boundingSpan(Vec3 origin, Vec3 direction) {
  const Vec3 to = kCentre - origin;
  const float along = dot(to, direction);
  const float off2 = dot(to, to) - along * along;
  const float half2 = kBoundingRadius_m * kBoundingRadius_m - off2;
  if (half2 <= 0) return {1, 0};
  const float half = std::sqrt(half2);
  return {std::max(along - half, 0.0f), along + half};
}

float NearLimbs::distance(Vec3 point) const {
  float distance = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < count_; ++i) {
    distance = blend(distance, limbDistance(*limbs_[i], point));
  }
  return distance;
}

}  // namespace

float mannequinDistance(Vec3 point) {
  float distance = std::numeric_limits<float>::max();
  for (const Limb& limb : kLimbs) distance = blend(distance, limbDistance(limb, point));
  return distance;
}

MannequinSurface mannequinSurface(Vec3 point) {
  MannequinSurface nearest{std::numeric_limits<float>::max(), {}};
  for (const Limb& limb : kLimbs) {
    const float distance = limbDistance(limb, point);
    if (distance < nearest.distance_m) nearest = {distance, limb.albedo};
  }
  return nearest;
}

Vec3 mannequinNormal(Vec3 point) {
  constexpr float kStep = 0.002f;  // four taps on a tetrahedron
  constexpr std::array<Vec3, 4> kTaps = {{{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}}};
  Vec3 gradient;
  for (const Vec3 tap : kTaps) {
    gradient = gradient + tap * mannequinDistance(point + tap * kStep);
  }
  return unit(gradient);
}

MannequinHit traceMannequin(Vec3 origin, Vec3 direction, float footprint) {
  const Span span = boundingSpan(origin, direction);
  MannequinHit hit;
  if (span.enter > span.leave) return hit;
  const NearLimbs limbs(origin, direction, kBlend_m);
  if (limbs.empty()) return hit;
  float t = span.enter;
  for (int step = 0; step < kMaxSteps && t < span.leave; ++step) {
    const Vec3 point = origin + direction * t;
    const float distance = limbs.distance(point);
    const float coverage = clamp01(0.5f - distance / (footprint * t));
    if (coverage > hit.coverage) hit = {coverage, point};
    if (distance < kHit_m) return {1, point};
    t += std::max(distance, kHit_m);
  }
  return hit;
}

float mannequinShadow(Vec3 point, Vec3 light, float softness) {
  const Vec3 direction = unit(light - point);
  const Span span = boundingSpan(point, direction);
  if (span.enter > span.leave) return 1;
  const NearLimbs limbs(point, direction, softness * span.leave);
  if (limbs.empty()) return 1;
  float visible = 1;
  float t = std::max(span.enter, 0.03f);
  for (int step = 0; step < kMaxSteps && t < span.leave; ++step) {
    const float distance = limbs.distance(point + direction * t);
    visible = std::min(visible, 0.5f + 0.5f * distance / (softness * t));
    if (visible <= 0) return 0;
    t += std::clamp(distance, 0.02f, 0.2f);
  }
  visible = clamp01(visible);
  return visible * visible * (3 - 2 * visible);
}

}  // namespace emulator
