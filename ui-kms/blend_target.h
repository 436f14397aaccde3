#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>

#include "hal/gl/objects.h"
#include "ui-kms/render_target.h"

namespace ui {

/// Where layers that show through each other are blended, in linear light: half floats, or where
/// the driver does not draw into those, sRGB bytes, which it blends in linear light, too. Both are
/// read as linear light.
///
/// Threads  The one that has the context.
/// Memory   create() compiles; resize() makes the texture.
class BlendTarget {
 public:
  enum class Storage : std::uint8_t { kHalfFloat, kSrgbBytes };

  [[nodiscard]] static std::expected<BlendTarget, std::string> create();

  /// Tries @p first before the other. Errors: one line; the size is as before.
  [[nodiscard]] std::expected<void, std::string> resize(std::uint32_t width_px,
                                                        std::uint32_t height_px,
                                                        Storage first = Storage::kHalfFloat);
  [[nodiscard]] Storage storage() const { return storage_; }

  /// Layers are drawn into this one,
  [[nodiscard]] const RenderTarget& target() const { return *target_; }
  /// and then all of it, as sRGB, into the bound framebuffer of the same size.
  void show() const;

 private:
  BlendTarget() = default;

  gl::Program program_;
  gl::VertexArray no_attributes_;
  std::optional<RenderTarget> target_;
  Storage storage_ = Storage::kHalfFloat;
};

}  // namespace ui
