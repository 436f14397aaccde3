#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

/// Signed distances: negative inside, metres. The fields are close to true distances near
/// their surfaces, and smooth enough to be polygonised and to take normals from.
namespace emulator::studio {

using Point = Eigen::Vector3f;

/// Two shapes that flow into each other over @p blend metres (cubic, so curvature has no jump).
[[nodiscard]] float smoothUnion(float a, float b, float blend);
[[nodiscard]] float smoothMeet(float a, float b, float blend);

/// @p shape without @p tool.
[[nodiscard]] inline float smoothCut(float shape, float tool, float blend) {
  return smoothMeet(shape, -tool, blend);
}

[[nodiscard]] float ellipsoid(const Point& p, const Point& centre, const Point& radii);

/// Straight limb of two radii with round ends.
[[nodiscard]] float capsule(const Point& p, const Point& a, const Point& b, float radius_a,
                            float radius_b);

/// One cross-section of a loft at @p t in [0, 1] of its axis: half an ellipse to the front, half
/// to the back, shifted to the front.
struct Section {
  float t;
  float side;
  float front;
  float back;
  float shift = 0;
};

/// A limb or trunk given by its cross-sections: the axis from @p a to @p b, sections between by
/// Catmull-Rom, ends rounded by @p cap.
class Loft {
 public:
  Loft(const Point& a, const Point& b, const Point& front, float cap,
       std::span<const Section> sections);

  [[nodiscard]] float distance(const Point& p) const;

  /// Where along the axis @p p lies, 0 at a, 1 at b.
  [[nodiscard]] float along(const Point& p) const { return (p - a_).dot(axis_) / length_; }

 private:
  struct Row {
    float side, front, back, shift;
  };
  static constexpr int kRows = 128;

  Point a_;
  Point axis_;
  Point front_;
  Point side_;
  float length_;
  float cap_;
  float reach_ = 0;
  std::array<Row, kRows + 2> rows_{};
};

}  // namespace emulator::studio
