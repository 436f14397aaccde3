#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/emulated/studio/backdrop.h"
#include "hal/emulated/studio/covers.h"
#include "hal/emulated/studio/gl.h"
#include "hal/emulated/studio/light_bake.h"
#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// Draws the empty hall: once per camera and in the best quality we have, because every moment is
/// laid over it. First what the varnished floor mirrors, then the hall without a lens at twice the
/// size, then that through the lens.
///
/// Threads  The thread of the current GlContext.
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
  GlVertexArray vertex_array_;
  GlBuffer vertices_;
  GlBuffer indices_;
  std::array<GlTexture, kCoverCount> covers_;
  GlTexture grain_;
  GlTexture light_;
  GlTexture mirrored_;  // of the last camera; bound by drawSurfaces
  GlProgram surface_program_;
  GlProgram lens_program_;
};

}  // namespace emulator::studio
