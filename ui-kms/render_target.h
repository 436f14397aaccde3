#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/gl/objects.h"
#include "rt/result.h"

namespace ui {

/// A picture to draw into. Row 0 is the picture's top row, as scanout wants it.
struct RenderTarget {
  gl::Texture colour;  ///< none where the framebuffer draws into other memory
  gl::Framebuffer framebuffer;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
};
[[nodiscard]] RenderTarget makeRenderTarget(std::uint32_t width_px, std::uint32_t height_px);
/// RGBA bytes, top row first. Errors: kInvalidConfig, @p rgba has another size.
[[nodiscard]] rt::Result<void> readTarget(const RenderTarget& target, std::span<std::byte> rgba);

}  // namespace ui
