#pragma once

#include <cstdint>
#include <vector>

#include "hal/emulated/studio/athlete/anatomy.h"
#include "hal/emulated/studio/athlete/distance.h"
#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

/// What a person wears, and the hair, as signed distances at rest: volumes that are hollow where
/// one can look into them (hems, sleeves, collar).
///
/// Threads  const, any. The anatomy must outlive it.
class Tailor {
 public:
  Tailor(const BodyShape& shape, const Anatomy& anatomy);

  [[nodiscard]] float shirt(const Point& p) const;
  [[nodiscard]] float shorts(const Point& p) const;
  [[nodiscard]] float sock(const Point& p) const;
  [[nodiscard]] float shoe(const Point& p) const;
  [[nodiscard]] float sole(const Point& p) const;
  [[nodiscard]] float hair(const Point& p) const;

 private:
  [[nodiscard]] float folds(const Point& p, float scale_m) const;

  const Anatomy& anatomy_;
  HairCut hair_cut_;
  std::uint32_t seed_;
  float cloth_m_;  ///< as thick as the polygons can show
  std::vector<Loft> shirt_;
  std::vector<Loft> sleeve_;
  std::vector<Loft> seat_;
  std::vector<Loft> leg_;
};

/// How far the soles reach under the floor of the rest pose.
inline constexpr float kSoleDepth_m = 0.012F;

}  // namespace emulator::studio
