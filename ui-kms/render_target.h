#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>

#include "hal/gl/objects.h"
#include "rt/result.h"
#include "ui-kms/orientation.h"

namespace ui {

/// A picture to draw into. Row 0 is the picture's top row, as scanout wants it.
struct RenderTarget {
  gl::Texture colour;  ///< none where the framebuffer draws into other memory
  gl::Framebuffer framebuffer;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
};
/// Of 8 bits per channel, or of another @p format. Errors: one line: larger than the driver's
/// textures, no memory, or a format that it does not draw into.
[[nodiscard]] std::expected<RenderTarget, std::string> makeRenderTarget(std::uint32_t width_px,
                                                                        std::uint32_t height_px,
                                                                        GLenum format = GL_RGBA8);
/// RGBA bytes of the upright picture, top row first. @p scratch: as large, for a screen that is
/// turned. Errors: kInvalidConfig, @p rgba has another size.
[[nodiscard]] rt::Result<void> readTarget(const RenderTarget& target, Orientation orientation,
                                          std::span<std::byte> scratch, std::span<std::byte> rgba);

}  // namespace ui
