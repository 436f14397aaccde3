#include "ui-kms/blend_target.h"

#include <utility>

#include "ui-kms/warp_shaders.h"

namespace ui {

std::expected<BlendTarget, std::string> BlendTarget::create() {
  auto program = gl::makeProgram("blend", shader::everywhereVertex(), shader::linearToScreen());
  if (!program) return std::unexpected(program.error());
  BlendTarget blend;
  blend.program_ = std::move(*program);
  blend.no_attributes_ = gl::makeVertexArray();
  return blend;
}

std::expected<void, std::string> BlendTarget::resize(std::uint32_t width_px,
                                                     std::uint32_t height_px, Storage first) {
  Storage storage = first;
  std::expected<RenderTarget, std::string> made = std::unexpected(std::string());
  if (first == Storage::kHalfFloat) made = makeRenderTarget(width_px, height_px, GL_RGBA16F);
  if (!made) {
    storage = Storage::kSrgbBytes;
    made = makeRenderTarget(width_px, height_px, GL_SRGB8_ALPHA8);
  }
  if (!made) return std::unexpected(made.error());
  target_ = std::move(*made);
  storage_ = storage;
  return {};
}

void BlendTarget::show() const {
  glUseProgram(program_.get());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target_->colour.get());
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace ui
