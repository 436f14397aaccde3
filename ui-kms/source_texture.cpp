#include "ui-kms/source_texture.h"

#include <utility>

#include "ui-kms/cpu_demosaic.h"

namespace ui {

std::expected<SourceTexture, std::string> SourceTexture::create(DemosaicSite site) {
  SourceTexture texture(site);
  if (site == DemosaicSite::kGpu) {
    auto pass = DemosaicPass::create();
    if (!pass) return std::unexpected(pass.error());
    texture.pass_ = std::move(*pass);
  }
  return texture;
}

void SourceTexture::prepare(std::uint32_t width_px, std::uint32_t height_px) {
  static_cast<void>(storageFor(width_px, height_px));
}

SourceTexture::Storage& SourceTexture::storageFor(std::uint32_t width_px, std::uint32_t height_px) {
  for (Storage& storage : storages_) {
    if (storage.colour.width_px == width_px && storage.colour.height_px == height_px) {
      return storage;
    }
  }
  // MIRRORED_REPEAT equals CLAMP_TO_EDGE within the one texel that a lookup may lie outside, and
  // keeps llvmpipe from the filter of 8-bit weights that it takes for the simpler modes: in linear
  // light those errors show in the shadows.
  Storage storage;
  storage.colour = makeRenderTarget(width_px, height_px);
  glBindTexture(GL_TEXTURE_2D, storage.colour.colour.get());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_MIRRORED_REPEAT);
  if (site_ == DemosaicSite::kGpu) {
    storage.mosaic = makeTexture(GL_R8, width_px, height_px, GL_NEAREST, GL_CLAMP_TO_EDGE);
  } else {
    storage.rgba.resize(std::size_t{4} * width_px * height_px);
  }
  return storages_.emplace_back(std::move(storage));
}

GLuint SourceTexture::upload(const hal::SourceImage& source) {
  Storage& storage = storageFor(source.width_px, source.height_px);
  const auto width = static_cast<GLsizei>(source.width_px);
  const auto height = static_cast<GLsizei>(source.height_px);
  glActiveTexture(GL_TEXTURE0);
  if (site_ == DemosaicSite::kCpu) {
    demosaicOnCpu(source, storage.rgba);
    // Straight from memory: mapping a pixel buffer and demosaicing into it measured the same.
    glBindTexture(GL_TEXTURE_2D, storage.colour.colour.get());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                    storage.rgba.data());
  } else {
    glBindTexture(GL_TEXTURE_2D, storage.mosaic.get());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, source.pixels);
    pass_->draw(storage.mosaic.get(), source.format, storage.colour);
  }
  glFinish();  // so that the instant that follows is true
  return storage.colour.colour.get();
}

}  // namespace ui
