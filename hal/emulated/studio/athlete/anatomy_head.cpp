#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/anatomy.h"

// The face in metres at kRestHeight_m, x >= 0. Heights: chin 1.574, mouth 1.617, base of the nose
// 1.640, eyes 1.686, brow 1.704, vertex 1.800 (proportions after Farkas' facial norms).
namespace emulator::studio {
namespace {

const Point kEye{0.0315F, 0.0765F, 1.6855F};
constexpr float kEyeball_m = 0.0125F;

}  // namespace

float Anatomy::cranium(const Point& p) const {
  return ellipsoid(p, {0, -0.010F, 1.704F}, {0.0765F, 0.0985F, 0.096F});
}

float Anatomy::eyes(const Point& p) const {
  return (Point{std::abs(p.x()), p.y(), p.z()} - kEye).norm() - kEyeball_m;
}

float Anatomy::ear(const Point& p) const {
  // A tilted saucer with a rim and a lobe.
  const Point q = p - Point{0.0765F, -0.004F, 1.668F};
  const float tilt = 0.22F;
  const Point r{q.x() - 0.35F * std::max(-q.y(), -0.01F), q.y() + tilt * q.z(),
                q.z() - tilt * q.y()};
  float d = ellipsoid(r, Point{0.002F, 0, 0}, {0.0070F, 0.0170F, 0.029F});
  d = smoothCut(d, ellipsoid(r, {0.0085F, 0.002F, 0.004F}, {0.0055F, 0.0115F, 0.0205F}), 0.004F);
  return smoothUnion(d, ellipsoid(r, {0.0F, 0.006F, -0.025F}, {0.0055F, 0.008F, 0.009F}), 0.006F);
}

float Anatomy::face(const Point& p) const {
  float d = smoothUnion(face_.front().distance(p), cranium(p), 0.03F);
  const float soft = female_ ? 0.6F : 1.0F;  // brow and chin

  // Cheekbones, jaw corners, chin, brow.
  d = smoothUnion(d, ellipsoid(p, {0.043F, 0.054F, 1.660F}, {0.021F, 0.022F, 0.014F}), 0.026F);
  d = smoothUnion(
      d,
      ellipsoid(p, {0.045F - 0.012F * (1 - soft), 0.008F, 1.606F}, {0.012F * soft, 0.024F, 0.018F}),
      0.03F);
  d = smoothUnion(
      d, ellipsoid(p, {0.036F - 0.008F * (1 - soft), 0.046F, 1.632F}, {0.022F, 0.030F, 0.026F}),
      0.03F);
  d = smoothUnion(d, ellipsoid(p, {0.008F, 0.083F, 1.583F}, {0.016F, 0.012F, 0.010F}), 0.018F);
  d = smoothUnion(
      d, ellipsoid(p, {0.028F, 0.0835F, 1.7035F}, {0.024F, 0.009F * soft + 0.002F, 0.0055F}),
      0.014F);

  // Eye sockets, then lids around the ball with an almond opening.
  d = smoothCut(d, ellipsoid(p, kEye + Point{0.001F, 0.024F, 0.0005F}, {0.0185F, 0.017F, 0.0105F}),
                0.014F);
  float lids = (p - kEye).norm() - (kEyeball_m + 0.0028F);
  const Point e = p - kEye;
  const float almond =
      ellipsoid(e, {0.0005F, 0.012F, -0.0005F - 0.03F * e.x()}, {0.0138F, 0.016F, 0.0045F});
  lids = smoothCut(lids, almond, 0.0012F);
  d = smoothUnion(d, lids, 0.005F);

  // Nose: bridge, tip, wings, nostrils.
  const float slim = female_ ? 0.9F : 1.0F;
  d = smoothUnion(
      d, capsule(p, {0, 0.0870F, 1.6880F}, {0, 0.1060F, 1.6520F}, 0.0058F * slim, 0.0085F * slim),
      0.012F);
  d = smoothUnion(d, ellipsoid(p, {0, 0.1085F, 1.6470F}, Point{0.0095F, 0.0105F, 0.0085F} * slim),
                  0.008F);
  d = smoothUnion(
      d, ellipsoid(p, {0.0115F * slim, 0.0970F, 1.6440F}, Point{0.0068F, 0.0095F, 0.0068F} * slim),
      0.006F);
  d = smoothCut(d, ellipsoid(p, {0.0062F, 0.1040F, 1.6385F}, {0.0033F, 0.0052F, 0.0032F}), 0.003F);

  // Mouth: the swell of the teeth, two lips, the line between, the corners, the philtrum.
  d = smoothUnion(d, ellipsoid(p, {0, 0.0790F, 1.6180F}, {0.0290F, 0.0165F, 0.0200F}), 0.018F);
  const float full = female_ ? 1.18F : 1.0F;
  d = smoothUnion(
      d, ellipsoid(p, {0.0070F, 0.0925F, 1.6212F}, Point{0.0150F, 0.0065F, 0.0042F * full}),
      0.006F);
  d = smoothUnion(
      d, ellipsoid(p, {0.0035F, 0.0915F, 1.6118F}, Point{0.0165F, 0.0068F, 0.0050F * full}),
      0.006F);
  d = smoothCut(d, capsule(p, {0, 0.1000F, 1.6168F}, {0.0245F, 0.0885F, 1.6165F}, 0.0017F, 0.0009F),
                0.003F);
  d = smoothCut(d, ellipsoid(p, {0.0265F, 0.0900F, 1.6165F}, {0.0040F, 0.0050F, 0.0035F}), 0.006F);
  d = smoothCut(d, capsule(p, {0, 0.1035F, 1.6360F}, {0, 0.1015F, 1.6255F}, 0.0028F, 0.0020F),
                0.006F);
  d = smoothCut(d, ellipsoid(p, {0, 0.0985F, 1.6010F}, {0.0180F, 0.0085F, 0.0055F}), 0.010F);
  return d;
}

float Anatomy::head(const Point& p) const {
  const Point q{std::abs(p.x()), p.y(), p.z()};
  float d = face(q);
  d = smoothUnion(d, neck_.front().distance(q), 0.022F);
  // Sternomastoid, and the larynx of a man.
  d = smoothUnion(
      d, capsule(q, {0.054F, -0.012F, 1.640F}, {0.014F, 0.020F, 1.475F}, 0.012F, 0.009F), 0.022F);
  if (!female_) {
    d = smoothUnion(d, ellipsoid(q, {0, 0.030F, 1.556F}, {0.009F, 0.009F, 0.014F}), 0.022F);
  }
  return smoothUnion(d, ear(q), 0.006F);
}

}  // namespace emulator::studio
