#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/moment.h"
#include "hal/emulated/studio/people_renderer.h"

namespace emulator::studio {

/// Who is in the hall and what they do: the athlete with the ball, and others who walk behind and
/// in front. The seed decides on all of it.
class World {
 public:
  enum class Clothes : std::uint8_t { kAll, kNone };
  /// Without clothes there are no surfaces, which take seconds to make: joints only.
  explicit World(std::uint64_t seed, Clothes clothes = Clothes::kAll);

  [[nodiscard]] const std::vector<CastMember>& cast() const { return cast_; }
  /// All who move while a shutter is open from @p second on.
  [[nodiscard]] Moment at(double second, double exposure_s) const;
  [[nodiscard]] const Performance& athlete() const { return people_.front().performance; }
  [[nodiscard]] const BodyShape& athleteShape() const { return athlete_shape_; }
  [[nodiscard]] std::size_t peopleCount() const { return people_.size(); }
  [[nodiscard]] const Performance& person(std::size_t i) const { return people_[i].performance; }

 private:
  struct Person {
    std::uint32_t body;
    Performance performance;
  };
  std::vector<CastMember> cast_;
  std::vector<Person> people_;
  BodyShape athlete_shape_;
  std::uint32_t ball_ = 0;
};

}  // namespace emulator::studio
