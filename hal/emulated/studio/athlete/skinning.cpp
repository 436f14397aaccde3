#include "hal/emulated/studio/athlete/skinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {
namespace {

using Weights = std::array<float, kBones>;

/// How thick the flesh of a bone is, to compare distances to bones; 0: no flesh of its own.
float fleshRadius(int bone) {
  if (bone < kMidBones) {
    switch (static_cast<MidBone>(bone)) {
      case MidBone::kPelvis:
        return 0.160F;
      case MidBone::kSpine:
        return 0.150F;
      case MidBone::kChest:
        return 0.155F;
      case MidBone::kNeck:
        return 0.060F;
      default:
        return 0.085F;
    }
  }
  switch (static_cast<SideBone>((bone - kMidBones) % kSideBones)) {
    case SideBone::kClavicle:
      return 0.065F;
    case SideBone::kUpperArm:
      return 0.060F;
    case SideBone::kUpperArmLow:
      return 0.050F;
    case SideBone::kForearm:
      return 0.045F;
    case SideBone::kForearmLow:
      return 0.035F;
    case SideBone::kHand:
      return 0.040F;
    case SideBone::kThumb1:
      return 0.015F;
    case SideBone::kThigh:
      return 0.085F;
    case SideBone::kShank:
      return 0.055F;
    case SideBone::kFoot:
      return 0.045F;
    case SideBone::kToes:
      return 0.040F;
    case SideBone::kShoulderHalf:
    case SideBone::kElbowHalf:
    case SideBone::kHipHalf:
    case SideBone::kKneeHalf:
      return 0;
    default:
      return 0.010F;  // fingers
  }
}

int nearestBone(const Point& p) {
  const auto& bones = restSkeleton();
  int best = 0;
  float least = std::numeric_limits<float>::max();
  for (int b = 0; b < kBones; ++b) {
    const float radius = fleshRadius(b);
    if (radius <= 0) continue;
    const auto& bone = bones[static_cast<std::size_t>(b)];
    const float d = capsule(p, bone.joint, bone.tip, 0, 0) / radius;
    if (d < least) {
      least = d;
      best = b;
    }
  }
  return best;
}

struct Neighbours {
  std::vector<std::uint32_t> first;  // per vertex, into list; one more at the end
  std::vector<std::uint32_t> list;
};

Neighbours neighboursOf(const Polygons& surface) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  const auto& t = surface.triangles;
  pairs.reserve(t.size() * 2);
  for (std::size_t i = 0; i < t.size(); i += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = t[i + e];
      const auto b = t[i + (e + 1) % 3];
      pairs.push_back({a, b});
      pairs.push_back({b, a});
    }
  }
  std::ranges::sort(pairs);
  const auto repeated = std::ranges::unique(pairs);
  pairs.erase(repeated.begin(), repeated.end());
  Neighbours result;
  result.first.assign(surface.positions.size() + 1, 0);
  for (const auto& pair : pairs) ++result.first[pair[0] + 1];
  for (std::size_t v = 0; v < surface.positions.size(); ++v) result.first[v + 1] += result.first[v];
  for (const auto& pair : pairs) result.list.push_back(pair[1]);
  return result;
}

void diffuse(const Neighbours& next, const std::vector<float>& rate, int rounds,
             std::vector<Weights>& weights) {
  std::vector<Weights> fresh(weights.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t v = 0; v < weights.size(); ++v) {
      const auto count = next.first[v + 1] - next.first[v];
      if (count == 0) {
        fresh[v] = weights[v];
        continue;
      }
      Eigen::Map<Eigen::Array<float, kBones, 1>> out(fresh[v].data());
      out.setZero();
      for (auto i = next.first[v]; i < next.first[v + 1]; ++i) {
        out += Eigen::Map<const Eigen::Array<float, kBones, 1>>(weights[next.list[i]].data());
      }
      const Eigen::Map<const Eigen::Array<float, kBones, 1>> old(weights[v].data());
      out = old * (1 - rate[v]) + out * (rate[v] / static_cast<float>(count));
    }
    weights.swap(fresh);
  }
}

/// Where two bones share a vertex, the bone that turns half as far takes the middle.
void giveToHalf(Weights& w, int above, int below, int half) {
  auto& a = w[static_cast<std::size_t>(above)];
  auto& b = w[static_cast<std::size_t>(below)];
  if (a + b < 1e-4F) return;
  const float share = a * b / (a + b);
  a -= share;
  b -= share;
  w[static_cast<std::size_t>(half)] += 2 * share;
}

Influence strongest(const Weights& w) {
  std::array<int, kBones> order{};
  for (int b = 0; b < kBones; ++b) order[static_cast<std::size_t>(b)] = b;
  std::ranges::partial_sort(order, order.begin() + 4, [&](int a, int b) {
    return w[static_cast<std::size_t>(a)] > w[static_cast<std::size_t>(b)];
  });
  Influence result;
  float sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += w[static_cast<std::size_t>(order[i])];
  for (std::size_t i = 0; i < 4; ++i) {
    result.bones[i] = static_cast<std::uint8_t>(order[i]);
    result.weights[i] = w[static_cast<std::size_t>(order[i])] / sum;
  }
  return result;
}

}  // namespace

std::vector<Influence> skinInfluences(const Polygons& skin) {
  std::vector<Weights> weights(skin.positions.size(), Weights{});
  std::vector<float> rate(skin.positions.size());
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const int bone = nearestBone(skin.positions[v]);
    weights[v][static_cast<std::size_t>(bone)] = 1;
    rate[v] = fleshRadius(bone) < 0.02F ? 0.25F : 0.9F;  // fingers bend sharply
  }
  const auto next = neighboursOf(skin);
  diffuse(next, rate, 36, weights);
  // The mesh of the neck is fine, yet the neck turns over all of its length.
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const Point& p = skin.positions[v];
    const bool neck = p.z() > 1.46F && p.z() < 1.635F && std::abs(p.x()) < 0.13F;
    rate[v] = neck ? 0.9F : 0.0F;
  }
  diffuse(next, rate, 90, weights);
  std::vector<Influence> result;
  result.reserve(weights.size());
  for (auto& w : weights) {
    for (const Side side : kSides) {
      using enum SideBone;
      const auto at = [&](SideBone bone) { return boneIndex(bone, side); };
      giveToHalf(w, at(kClavicle), at(kUpperArm), at(kShoulderHalf));
      giveToHalf(w, boneIndex(MidBone::kChest), at(kUpperArm), at(kShoulderHalf));
      giveToHalf(w, at(kUpperArmLow), at(kForearm), at(kElbowHalf));
      giveToHalf(w, boneIndex(MidBone::kPelvis), at(kThigh), at(kHipHalf));
      giveToHalf(w, at(kThigh), at(kShank), at(kKneeHalf));
    }
    result.push_back(strongest(w));
  }
  return result;
}

std::vector<Influence> clothInfluences(const Polygons& cloth, const Polygons& skin,
                                       std::span<const Influence> skin_influences,
                                       int smoothing_rounds) {
  constexpr float kCell_m = 0.03F;
  const auto key = [](const Eigen::Vector3i& c) {
    return (static_cast<std::int64_t>(c.x()) * 4096 + c.y()) * 4096 + c.z();
  };
  const auto cellOf = [&](const Point& p) {
    return Eigen::Vector3i((p / kCell_m).array().floor().template cast<int>());
  };
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> buckets;
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    buckets[key(cellOf(skin.positions[v]))].push_back(static_cast<std::uint32_t>(v));
  }
  std::vector<Weights> weights;
  weights.reserve(cloth.positions.size());
  for (const Point& p : cloth.positions) {
    Weights sum{};
    float total = 0;
    const Eigen::Vector3i centre = cellOf(p);
    for (int reach = 1; total <= 0 && reach < 8; ++reach) {
      for (int dz = -reach; dz <= reach; ++dz) {
        for (int dy = -reach; dy <= reach; ++dy) {
          for (int dx = -reach; dx <= reach; ++dx) {
            const auto found = buckets.find(key(centre + Eigen::Vector3i{dx, dy, dz}));
            if (found == buckets.end()) continue;
            for (const auto v : found->second) {
              const float near = 1 / (1e-6F + (skin.positions[v] - p).squaredNorm());
              const float w = near * near;
              const auto& from = skin_influences[v];
              for (std::size_t i = 0; i < 4; ++i) sum[from.bones[i]] += w * from.weights[i];
              total += w;
            }
          }
        }
      }
    }
    if (total <= 0) {
      sum[static_cast<std::size_t>(nearestBone(p))] = 1;
      total = 1;
    }
    for (auto& w : sum) w /= total;
    weights.push_back(sum);
  }
  diffuse(neighboursOf(cloth), std::vector<float>(weights.size(), 0.8F), smoothing_rounds, weights);
  std::vector<Influence> result;
  result.reserve(weights.size());
  for (const auto& w : weights) result.push_back(strongest(w));
  return result;
}

}  // namespace emulator::studio
