#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/emulated/studio/athlete/anatomy.h"
#include "hal/emulated/studio/athlete/body.h"
#include "hal/emulated/studio/athlete/skinning.h"
#include "hal/emulated/studio/athlete/surface_net.h"
#include "hal/emulated/studio/athlete/tailor.h"

namespace emulator::studio {
namespace {

/// How many sheets a surface has: sets of vertices joined by triangles.
std::size_t pieces(std::size_t vertices, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> root(vertices);
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    root[find(triangles[t + 1])] = find(triangles[t]);
    root[find(triangles[t + 2])] = find(triangles[t]);
  }
  std::set<std::uint32_t> roots;
  for (const auto v : triangles) roots.insert(find(v));
  return roots.size();
}

/// Every edge is walked once in each direction.
bool closed(const std::vector<std::uint32_t>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = triangles[t + e];
      const auto b = triangles[t + (e + 1) % 3];
      if (a < b) {
        ++balance[{a, b}];
      } else {
        --balance[{b, a}];
      }
    }
  }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

Polygons skinOf(const BodyShape& shape) {
  const Anatomy anatomy(shape);
  return polygonise(
      [&](const Point& p) { return anatomy.skin(p); },
      gridLines(-1.0F, 1.0F, 0.012F, {{0.66F, 0.92F, 0.006F}, {-0.92F, -0.66F, 0.006F}}),
      gridLines(-0.22F, 0.26F, 0.012F, {{-0.05F, 0.12F, 0.006F}}),
      gridLines(-0.05F, 1.85F, 0.012F, {{1.09F, 1.22F, 0.006F}, {1.55F, 1.73F, 0.006F}}));
}

const Body& athlete() {
  static const Body kBody = [] {
    BodyShape shape;
    shape.cell_scale = 1.4;
    return makeBody(shape);
  }();
  return kBody;
}

TEST(SurfaceNet, MakesARoundClosedSphere) {
  const auto lines = gridLines(-0.2F, 0.2F, 0.01F, {{-0.05F, 0.02F, 0.004F}});
  const auto sphere =
      polygonise([](const Point& p) { return p.norm() - 0.1F; }, lines, lines, lines);
  ASSERT_GT(sphere.positions.size(), 500U);
  EXPECT_TRUE(closed(sphere.triangles));
  EXPECT_EQ(pieces(sphere.positions.size(), sphere.triangles), 1U);
  for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
    EXPECT_NEAR(sphere.positions[v].norm(), 0.1F, 1e-4F);
    EXPECT_GT(sphere.normals[v].dot(sphere.positions[v].normalized()), 0.999F);
  }
  for (std::size_t t = 0; t < sphere.triangles.size(); t += 3) {
    const Point& a = sphere.positions[sphere.triangles[t]];
    const Point& b = sphere.positions[sphere.triangles[t + 1]];
    const Point& c = sphere.positions[sphere.triangles[t + 2]];
    EXPECT_GE((b - a).cross(c - a).dot(a + b + c), 0.0F)
        << "triangle " << t / 3 << " turns inwards";
  }
}

TEST(SurfaceNet, RefinesWhereAskedAndNeverJumps) {
  const auto lines = gridLines(0.0F, 1.0F, 0.02F, {{0.4F, 0.5F, 0.005F}});
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const float before = lines[i - 1] - lines[i - 2];
    const float after = lines[i] - lines[i - 1];
    EXPECT_LE(std::max(before, after) / std::min(before, after), 1.45F);
    EXPECT_LE(after, 0.0201F);
    if (lines[i] > 0.405F && lines[i] < 0.495F) {
      EXPECT_NEAR(after, 0.005F, 1e-5F);
    }
  }
}

class EverySex : public testing::TestWithParam<Sex> {};
INSTANTIATE_TEST_SUITE_P(AthleteSkin, EverySex, testing::Values(Sex::kMale, Sex::kFemale));

TEST_P(EverySex, HasOneClosedSkin) {
  BodyShape shape;
  shape.sex = GetParam();
  for (const double build : {-0.8, 0.8}) {
    shape.build = build;
    const auto skin = skinOf(shape);
    EXPECT_TRUE(closed(skin.triangles));
    EXPECT_EQ(pieces(skin.positions.size(), skin.triangles), 1U) << "build " << build;
  }
}

TEST_P(EverySex, IsSmooth) {
  BodyShape shape;
  shape.sex = GetParam();
  const auto skin = skinOf(shape);
  std::size_t sharp = 0;
  for (std::size_t t = 0; t < skin.triangles.size(); t += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = skin.triangles[t + e];
      const auto b = skin.triangles[t + (e + 1) % 3];
      if (skin.normals[a].dot(skin.normals[b]) < 0.5F) ++sharp;
    }
  }
  // Lids, lips, nostrils, between the fingers.
  EXPECT_LT(static_cast<double>(sharp), 0.02 * static_cast<double>(skin.triangles.size()));
}

TEST(AthleteBody, IsAsTallAndWideAsAPerson) {
  Point low = Point::Constant(9);
  Point high = Point::Constant(-9);
  for (const auto& v : athlete().vertices) {
    low = low.cwiseMin(v.position);
    high = high.cwiseMax(v.position);
  }
  EXPECT_NEAR(high.z() - low.z(), 1.82F, 0.03F) << "vertex to soles, with hair and shoes";
  EXPECT_NEAR(low.z(), -kSoleDepth_m, 0.003F);
  EXPECT_NEAR(high.x() - low.x(), 1.70F, 0.08F)
      << "finger tips, arms a little below the horizontal";
  EXPECT_NEAR(high.x(), -low.x(), 0.01F);
}

TEST(AthleteBody, HasWeightsThatSumToOneAndNameBones) {
  for (const auto& v : athlete().vertices) {
    EXPECT_NEAR(v.weights[0] + v.weights[1] + v.weights[2] + v.weights[3], 1.0F, 1e-4F);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT(v.bones[i], kBones);
      EXPECT_GE(v.weights[i], 0.0F);
    }
    EXPECT_NEAR(v.normal.norm(), 1.0F, 1e-3F);
    EXPECT_TRUE(v.position.allFinite());
  }
}

TEST(AthleteBody, MovesNothingAcrossTheMiddle) {
  // A right limb's bone never pulls at the left limb.
  for (const auto& v : athlete().vertices) {
    if (std::abs(v.position.x()) < 0.16F) continue;
    const Side other = v.position.x() > 0 ? Side::kLeft : Side::kRight;
    for (std::size_t i = 0; i < 4; ++i) {
      if (v.weights[i] < 0.02F || v.bones[i] < kMidBones) continue;
      EXPECT_NE((v.bones[i] - kMidBones) / kSideBones, static_cast<int>(other))
          << athlete().bones[v.bones[i]].name << " at x " << v.position.x() << " z "
          << v.position.z();
    }
  }
}

TEST(AthleteBody, HasOneMaterialPerTriangleAndAllOfThem) {
  std::set<std::uint8_t> seen;
  const auto& body = athlete();
  for (std::size_t t = 0; t < body.triangles.size(); t += 3) {
    const auto material = body.vertices[body.triangles[t]].material;
    EXPECT_EQ(body.vertices[body.triangles[t + 1]].material, material);
    EXPECT_EQ(body.vertices[body.triangles[t + 2]].material, material);
    seen.insert(material);
  }
  for (std::uint8_t m = 0; m < static_cast<std::uint8_t>(Material::kBall); ++m) {
    EXPECT_TRUE(seen.contains(m)) << "material " << int{m} << " is nowhere";
  }
}

TEST(AthleteBody, IsTheSameEachTimeAndAnotherForAnotherSeed) {
  BodyShape shape;
  shape.cell_scale = 3;
  const auto first = makeBody(shape);
  const auto second = makeBody(shape);
  ASSERT_EQ(first.vertices.size(), second.vertices.size());
  for (std::size_t v = 0; v < first.vertices.size(); ++v) {
    ASSERT_EQ(first.vertices[v].position, second.vertices[v].position);
    ASSERT_EQ(first.vertices[v].weights, second.vertices[v].weights);
  }
  shape.seed = 2;
  const auto other = makeBody(shape);
  const bool same =
      other.vertices.size() == first.vertices.size() &&
      std::ranges::equal(other.vertices, first.vertices, {}, &Vertex::position, &Vertex::position);
  EXPECT_FALSE(same) << "the folds of the clothes do not depend on the seed";
}

TEST(AthleteBody, HasABallOfUnitRadius) {
  for (const auto& v : makeBall().vertices) EXPECT_NEAR(v.position.norm(), 1.0F, 1e-5F);
}

TEST(Skeleton, HasParentsBeforeChildrenAndMirroredSides) {
  const auto& bones = restSkeleton();
  for (int b = 0; b < kBones; ++b) EXPECT_LT(bones[static_cast<std::size_t>(b)].parent, b);
  for (int s = 0; s < kSideBones; ++s) {
    const auto bone = static_cast<SideBone>(s);
    const auto& right = bones[static_cast<std::size_t>(boneIndex(bone, Side::kRight))];
    const auto& left = bones[static_cast<std::size_t>(boneIndex(bone, Side::kLeft))];
    EXPECT_EQ(right.joint.x(), -left.joint.x());
    EXPECT_EQ(right.joint.z(), left.joint.z());
  }
}

}  // namespace
}  // namespace emulator::studio
