#include "ui-kms/source_texture.h"

#include <utility>

#include "ui-kms/cpu_demosaic.h"
#include "ui-kms/import_probe.h"

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
    storage.mosaic = gl::makeTexture(GL_R8, static_cast<GLsizei>(width_px),
                                     static_cast<GLsizei>(height_px), GL_NEAREST, GL_CLAMP_TO_EDGE);
  } else {
    storage.rgba.resize(std::size_t{4} * width_px * height_px);
  }
  return storages_.emplace_back(std::move(storage));
}

void SourceTexture::tryImport(const gl::Context& context, std::uint32_t width_px,
                              std::uint32_t height_px) {
  const auto started = startImport(context, width_px, height_px);
  upload_reason_ = started ? std::string() : started.error();
}

std::expected<void, std::string> SourceTexture::startImport(const gl::Context& context,
                                                            std::uint32_t width_px,
                                                            std::uint32_t height_px) {
  if (site_ == DemosaicSite::kCpu) return std::unexpected("the CPU demosaics");
  if (!context.readsForeignMemory()) {
    return std::unexpected("a software renderer on a KMS device cannot read imported memory");
  }
  if (width_px == 0 || height_px == 0) return std::unexpected("the frames' size is not known");
  auto import = DmaBufImport::create();
  if (!import) return std::unexpected(import.error());
  auto probed = probeImport(**import, *pass_, width_px, height_px);
  if (probed) import_ = std::move(*import);
  return probed;
}

SourceTexture::Loaded SourceTexture::load(const hal::SourceImage& source) {
  Storage& storage = storageFor(source.width_px, source.height_px);
  glActiveTexture(GL_TEXTURE0);
  Loaded loaded{.colour = storage.colour.colour.get()};
  if (site_ == DemosaicSite::kCpu) {
    demosaicOnCpu(source, storage.rgba);
    // Straight from memory: mapping a pixel buffer and demosaicing into it measured the same.
    upload(loaded.colour, GL_RGBA, source, storage.rgba.data());
  } else {
    GLuint mosaic = import_ ? import_->tryImport(source) : 0;
    loaded.imported = mosaic != 0;
    if (!loaded.imported) {
      mosaic = storage.mosaic.get();
      upload(mosaic, GL_RED, source, source.pixels);
    }
    pass_->draw(mosaic, source.format, storage.colour);
  }
  // So that the instant that follows is true, and the frame's slot may be written again.
  glFinish();
  return loaded;
}

void SourceTexture::upload(GLuint texture, GLenum format, const hal::SourceImage& source,
                           const std::byte* data) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(source.width_px),
                  static_cast<GLsizei>(source.height_px), format, GL_UNSIGNED_BYTE, data);
}

}  // namespace ui
