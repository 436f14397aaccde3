#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/emulated/studio/backdrop.h"
#include "hal/emulated/studio/covers.h"
#include "hal/emulated/studio/light_bake.h"
#include "hal/emulated/studio/studio_gl.h"
#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// Draws the empty hall: once per camera and in the best quality we have, because every moment is
/// laid over it. First what the varnished floor mirrors, then the hall without a lens at twice the
/// size, then that through the lens.
///
/// Threads  The thread of the current gl::Context.
class HallRenderer {
 public:
  HallRenderer(const std::vector<Surface>& surfaces, const CoverPictures& covers,
               const cv::Mat& floor_grain, const LightMap& light);

  [[nodiscard]] Backdrop draw(const StudioCamera& camera);

 private:
  struct Batch {
    Cover cover;
    GLsizei first = 0;
    GLsizei count = 0;
  };
  struct Pinhole {  // a camera without a lens, wide enough to hold all that the lens bends in
    int width = 0;
    int height = 0;
    std::array<float, 4> f{};  // fx fy cx cy
  };
  void drawSurfaces(const StudioCamera& camera, const Pinhole& pinhole, bool mirrored) const;
  static Pinhole widen(const StudioCamera& camera, double scale);

  std::vector<Batch> batches_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
  std::array<gl::Texture, kCoverCount> covers_;
  gl::Texture grain_;
  gl::Texture light_;
  gl::Texture mirrored_;  // of the last camera; bound by drawSurfaces
  gl::Program surface_program_;
  gl::Program lens_program_;
};

}  // namespace emulator::studio
