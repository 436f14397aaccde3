#include "ui-kms/source_cache.h"

#include <algorithm>
#include <utility>

#include "hal/scene.h"
#include "ui-kms/cpu_demosaic.h"
#include "ui-kms/import_probe.h"

namespace ui {

std::expected<SourceCache, std::string> SourceCache::create(DemosaicSite site) {
  SourceCache cache(site);
  if (site == DemosaicSite::kGpu) {
    auto pass = DemosaicPass::create();
    if (!pass) return std::unexpected(pass.error());
    cache.pass_ = std::move(*pass);
  }
  return cache;
}

std::expected<void, std::string> SourceCache::prepare(SizePx size) {
  if (std::ranges::find(storages_, size, &Storage::size) != storages_.end()) return {};
  auto storage = makeStorage(size);
  if (!storage) return std::unexpected(storage.error());
  storages_.push_back(std::move(*storage));
  return {};
}

std::expected<SourceCache::Storage, std::string> SourceCache::makeStorage(SizePx size) const {
  Storage storage;
  storage.size = size;
  storage.imports = std::ranges::find(importable_, size) != importable_.end();
  for (std::uint32_t i = 0; i < hal::Scene::kMostLayers; ++i) {
    auto colour = makeRenderTarget(size.width, size.height);
    if (!colour) return std::unexpected("frames of the cameras: " + colour.error());
    // MIRRORED_REPEAT equals CLAMP_TO_EDGE within the one texel that a lookup may lie outside, and
    // keeps llvmpipe from the filter of 8-bit weights that it takes for the simpler modes: in
    // linear light those errors show in the shadows.
    glBindTexture(GL_TEXTURE_2D, colour->colour.get());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_MIRRORED_REPEAT);
    storage.entries.push_back({.colour = std::move(*colour)});
  }
  if (site_ == DemosaicSite::kGpu) {
    storage.mosaic =
        gl::makeTexture(GL_R8, static_cast<GLsizei>(size.width), static_cast<GLsizei>(size.height),
                        GL_NEAREST, GL_CLAMP_TO_EDGE);
  } else {
    storage.rgba.resize(std::size_t{4} * size.width * size.height);
  }
  return storage;
}

SourceCache::Storage* SourceCache::storageFor(SizePx size) {
  const auto known = std::ranges::find(storages_, size, &Storage::size);
  if (known != storages_.end()) return &*known;
  return prepare(size) ? &storages_.back() : nullptr;
}

void SourceCache::tryImport(const gl::Context& context, const std::vector<SizePx>& sizes) {
  const auto started = startImport(context, sizes);
  upload_reason_ = started ? std::string() : started.error();
}

std::expected<void, std::string> SourceCache::startImport(const gl::Context& context,
                                                          const std::vector<SizePx>& sizes) {
  if (site_ == DemosaicSite::kCpu) return std::unexpected("the CPU demosaics");
  if (!context.readsForeignMemory()) {
    return std::unexpected("a software renderer on a KMS device cannot read imported memory");
  }
  if (sizes.empty()) return std::unexpected("the frames' size is not known");
  auto import = DmaBufImport::create();
  if (!import) return std::unexpected(import.error());
  std::expected<void, std::string> all;
  for (const SizePx size : sizes) {
    if (const auto probed = probeImport(**import, *pass_, size.width, size.height)) {
      importable_.push_back(size);
    } else {
      all = probed;
    }
  }
  if (!importable_.empty()) import_ = std::move(*import);
  return all;
}

SourceCache::Loaded SourceCache::load(const hal::SourceImage& source, std::uint64_t content) {
  Storage* const storage = storageFor({source.width_px, source.height_px});
  if (storage == nullptr) return {};
  auto& entries = storage->entries;
  auto entry = std::ranges::find_if(entries, [&](const Entry& held) {
    return content != 0 && held.content == content && held.format == source.format;
  });
  if (entry == entries.end()) {
    entry = std::ranges::min_element(entries, {}, &Entry::used);
    entry->content = content;
    entry->format = source.format;
    demosaic(source, *storage, *entry);
  }
  entry->used = ++loads_;
  return {.colour = entry->colour.colour.get(), .imported = entry->imported};
}

void SourceCache::demosaic(const hal::SourceImage& source, Storage& storage, Entry& entry) {
  glActiveTexture(GL_TEXTURE0);
  unfinished_ = true;
  if (site_ == DemosaicSite::kCpu) {
    demosaicOnCpu(source, storage.rgba);
    // Straight from memory: mapping a pixel buffer and demosaicing into it measured the same.
    upload(entry.colour.colour.get(), GL_RGBA, source, storage.rgba.data());
    return;
  }
  GLuint mosaic = storage.imports ? import_->tryImport(source) : 0;
  entry.imported = mosaic != 0;
  if (!entry.imported) {
    mosaic = storage.mosaic.get();
    upload(mosaic, GL_RED, source, source.pixels);
  }
  pass_->draw(mosaic, source.format, entry.colour);
}

void SourceCache::finish() {
  if (std::exchange(unfinished_, false)) glFinish();
}

void SourceCache::upload(GLuint texture, GLenum format, const hal::SourceImage& source,
                         const std::byte* data) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(source.width_px),
                  static_cast<GLsizei>(source.height_px), format, GL_UNSIGNED_BYTE, data);
}

}  // namespace ui
