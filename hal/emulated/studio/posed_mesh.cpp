#include "hal/emulated/studio/posed_mesh.h"

#include <algorithm>
#include <cmath>

namespace emulator::studio {

using Matrix34 = Eigen::Matrix<float, 3, 4>;

void poseMesh(const Body& body, const std::vector<Eigen::Affine3f>& opens,
              const std::vector<Eigen::Affine3f>& closes, PosedMesh& mesh) {
  mesh.vertices.resize(body.vertices.size());
  mesh.bounds.setEmpty();
  float way2 = 0;
  const auto blend = [](const Vertex& v, const std::vector<Eigen::Affine3f>& bones) -> Matrix34 {
    Matrix34 sum = v.weights[0] * bones[v.bones[0]].affine();
    for (std::size_t k = 1; k < 4 && v.weights[k] > 0; ++k)
      sum += v.weights[k] * bones[v.bones[k]].affine();
    return sum;
  };
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    const Vertex& v = body.vertices[i];
    PosedMesh::Vertex& to = mesh.vertices[i];
    const Matrix34 first = blend(v, opens);
    const Matrix34 last = blend(v, closes);
    to.opens = first.leftCols<3>() * v.position + first.col(3);
    to.closes = last.leftCols<3>() * v.position + last.col(3);
    to.normal = (first.leftCols<3>() * v.normal).normalized();
    mesh.bounds.extend(to.opens);
    mesh.bounds.extend(to.closes);
    way2 = std::max(way2, (to.closes - to.opens).squaredNorm());
  }
  mesh.way_m = std::sqrt(way2);
}

}  // namespace emulator::studio
