#include "hal/emulated/studio/world.h"

#include <array>
#include <thread>

#include "hal/emulated/studio/athlete/draw_shape.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2d;

constexpr double kAthleteCells = 1.5;  // the cameras are near: polygons of two to three pixels
constexpr double kOthersCells = 2.0;
constexpr double kShadowCells = 3.2;

CastMember dress(BodyShape shape) {
  CastMember member{.surface = makeBody(shape), .shadow = {}};
  shape.cell_scale = kShadowCells;
  member.shadow = makeBody(shape);
  return member;
}

}  // namespace

World::World(std::uint64_t seed, Clothes clothes) {
  Random random(seed ^ 0x77aa'11);
  std::array<BodyShape, 3> shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i] = drawShape(random.next());
    shapes[i].cell_scale = i == 0 ? kAthleteCells : kOthersCells;
  }
  athlete_shape_ = shapes[0];
  cast_.resize(shapes.size());
  if (clothes == Clothes::kAll) {
    std::vector<std::jthread> tailors;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      tailors.emplace_back([&, i] { cast_[i] = dress(shapes[i]); });
    }
  }
  ball_ = static_cast<std::uint32_t>(cast_.size());
  if (clothes == Clothes::kAll) cast_.push_back({.surface = makeBall(), .shadow = makeBall()});

  PerformanceOptions athlete;
  athlete.shape = shapes[0];
  athlete.heading = -1.75;  // to the right as the cameras see it, a little towards them
  athlete.home = {-0.35, 0.05};
  athlete.route = {Vector2d(-1.5, -0.6), Vector2d(1.5, -0.6), Vector2d(1.6, 1.5),
                   Vector2d(-1.5, 1.5)};
  people_.push_back({0, Performance(random.next(), athlete)});

  PerformanceOptions around;  // in front of the athlete and behind
  around.shape = shapes[1];
  around.home = {-2.6, 3.0};
  around.actions = {Action::kWalk};
  around.route = {Vector2d(-2.7, 4.3), Vector2d(-2.6, -0.8), Vector2d(-1.4, -2.0),
                  Vector2d(1.4, -2.0), Vector2d(2.7, -0.8),  Vector2d(2.9, 4.3)};
  around.ball_radius_m = 0;
  people_.push_back({1, Performance(random.next(), around)});

  PerformanceOptions behind;
  behind.shape = shapes[2];
  behind.home = {3.4, 3.2};
  behind.actions = {Action::kWalk, Action::kStretch, Action::kStand, Action::kRun};
  behind.route = {Vector2d(3.6, 2.6), Vector2d(3.8, 4.8), Vector2d(-4.6, 4.9), Vector2d(-4.5, 2.7)};
  behind.ball_radius_m = 0;
  people_.push_back({2, Performance(random.next(), behind)});
}

Moment World::at(double second, double exposure_s) const {
  Moment moment{.second = second, .bodies = {}};
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const PoseAt opens = people_[i].performance.at(second);
    const PoseAt closes = people_[i].performance.at(second + exposure_s);
    moment.bodies.push_back(
        {.body = people_[i].body, .opens = opens.bones, .closes = closes.bones});
    if (i == 0 && opens.ball_state != BallState::kNone && opens.ball_radius_m > 0) {
      const auto place = [&](const PoseAt& pose) {
        Eigen::Affine3f placed = Eigen::Affine3f::Identity();
        placed.translate(pose.ball.cast<float>()).scale(static_cast<float>(opens.ball_radius_m));
        return std::vector<Eigen::Affine3f>{placed};
      };
      moment.bodies.push_back({.body = ball_, .opens = place(opens), .closes = place(closes)});
    }
  }
  return moment;
}

}  // namespace emulator::studio
