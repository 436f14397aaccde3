#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace emulator::studio {

/// Which picture covers a surface of the hall.
enum class Cover : std::uint8_t {
  kFloor,
  kBrick,
  kPlank,
  kPlaster,
  kCeiling,
  kWood,
  kVinyl,
  kMetal,
  kPosters,
  kNet,  ///< with holes: neither casts a shadow nor hides what is behind its meshes
  kBallSkin,
  kGlow,  ///< shines by itself: lamps, windows, signs; the tint is its radiance
};
inline constexpr std::size_t kCoverCount = 12;

/// A curved or flat four-cornered piece of the hall. Corners and what belongs to them in the order
/// (u, v) = (0,0) (1,0) (0,1) (1,1).
struct Surface {
  std::array<Eigen::Vector3f, 4> corners;
  std::array<Eigen::Vector3f, 4> normals;
  std::array<Eigen::Vector2f, 4> texture;
  Eigen::Vector3f tint = {1, 1, 1};  ///< multiplies the cover's albedo
  Cover cover = Cover::kPlaster;
  float light_step_m = 0.1f;  ///< how finely the light that falls on it is kept

  [[nodiscard]] Eigen::Vector3f at(float u, float v) const;
  [[nodiscard]] Eigen::Vector3f normalAt(float u, float v) const;
};

/// Puts surfaces together. Everything is in metres; textures that repeat are @p tile_m wide.
class SurfaceBuilder {
 public:
  struct Paint {
    Cover cover = Cover::kPlaster;
    Eigen::Vector3f tint = {1, 1, 1};
    float tile_m = 1;
    float light_step_m = 0.1f;
  };

  /// From a corner along two edges; faces edge_u x edge_v. The texture repeats.
  void sheet(const Eigen::Vector3f& corner, const Eigen::Vector3f& edge_u,
             const Eigen::Vector3f& edge_v, const Paint& paint);
  /// The same with one piece of the texture, from @p low to @p high in its own units.
  void picture(const Eigen::Vector3f& corner, const Eigen::Vector3f& edge_u,
               const Eigen::Vector3f& edge_v, const Paint& paint, const Eigen::Vector2f& low,
               const Eigen::Vector2f& high);
  /// Six sides about @p centre; @p size along its own axes, turned by @p turn about z.
  void box(const Eigen::Vector3f& centre, const Eigen::Vector3f& size, float turn,
           const Paint& paint);
  /// A round bar with closed ends.
  void bar(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius, int sides,
           const Paint& paint);
  void ball(const Eigen::Vector3f& centre, float radius, const Paint& paint);

  [[nodiscard]] std::vector<Surface> take() { return std::move(surfaces_); }

 private:
  std::vector<Surface> surfaces_;
};

}  // namespace emulator::studio
