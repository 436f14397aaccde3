#pragma once

#include <vector>

#include "hal/emulated/studio/athlete/distance.h"
#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

/// The flesh of a person at rest as signed distances, metres at kRestHeight_m. Both halves are
/// alike, so every shape is modelled once, for x >= 0.
///
/// Threads  const, any.
class Anatomy {
 public:
  explicit Anatomy(const BodyShape& shape);

  /// All skin in one surface, without eyeballs.
  [[nodiscard]] float skin(const Point& p) const;
  [[nodiscard]] float eyes(const Point& p) const;

  [[nodiscard]] float head(const Point& p) const;
  [[nodiscard]] float cranium(const Point& p) const;  ///< the smooth egg under the hair
  [[nodiscard]] float trunk(const Point& p) const;
  [[nodiscard]] float arm(const Point& p) const;
  [[nodiscard]] float leg(const Point& p) const;
  [[nodiscard]] float foot(const Point& p) const;

  /// 0 slight .. 1 heavy, and whether the shape is a woman's, for the tailor.
  [[nodiscard]] float girth() const { return girth_; }
  [[nodiscard]] bool female() const { return female_; }

 private:
  struct Tube {
    Point a, b;
    float radius_a, radius_b;
  };

  [[nodiscard]] float face(const Point& p) const;
  [[nodiscard]] float ear(const Point& p) const;
  [[nodiscard]] float hand(const Point& p) const;

  float girth_;
  bool female_;
  std::vector<Loft> trunk_;
  std::vector<Loft> neck_;
  std::vector<Loft> face_;
  std::vector<Loft> arm_;
  std::vector<Loft> leg_;
  std::vector<Loft> palm_;
  std::vector<Loft> foot_;
  std::vector<Tube> fingers_;
};

}  // namespace emulator::studio
