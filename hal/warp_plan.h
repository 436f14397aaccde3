#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/colour_model.h"
#include "hal/edge_mask.h"
#include "hal/lens.h"
#include "hal/pixel_format.h"
#include "rt/dma_buf.h"

namespace hal {

/// One stored frame, borrowed for the duration of a render() call.
struct SourceImage {
  const std::byte* pixels = nullptr;  ///< rows of width_px bytes, no padding
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  PixelFormat format = PixelFormat::kBayerRG8;
  rt::DmaBufPart dma_buf;  ///< the same bytes for a GPU, if valid; they hold for render(), too
};

/// Everything the renderer needs to draw one view: pure data, made by the warp planner.
/// The renderer samples backwards: display pixel -> undistorted camera pixel by
/// H_camera_display -> distorted source pixel by the lens. Pixel centres at integers.
struct WarpPlan {
  SourceImage source;
  std::array<double, 9> H_camera_display{};  ///< row-major
  Lens lens;
  ColourModel colour;
  EdgeMask edge;
};

}  // namespace hal
