#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "hal/display.h"
#include "ui-kms/demosaic_pass.h"
#include "ui-kms/gl_objects.h"

namespace ui {

enum class DemosaicSite : std::uint8_t {
  kAuto,  ///< the CPU under a software renderer, otherwise the GPU
  kCpu,   ///< SIMD on the calling thread, then four bytes per pixel are uploaded
  kGpu,   ///< one byte per pixel is uploaded and a shader does the rest
};

/// The shown view as a texture of linear light. Only the one view that is shown is uploaded.
///
/// Threads  The one that has the context.
/// Memory   Storage per source size is made by prepare(), or at that size's first upload.
class SourceTexture {
 public:
  /// @p site: kCpu or kGpu.
  [[nodiscard]] static std::expected<SourceTexture, std::string> create(DemosaicSite site);

  void prepare(std::uint32_t width_px, std::uint32_t height_px);

  /// Demosaics and uploads; the texture holds until the next call. Done when it returns.
  [[nodiscard]] GLuint upload(const hal::SourceImage& source);

 private:
  struct Storage {
    RenderTarget colour;          // RGBA, linear light
    GlTexture mosaic;             // kGpu
    std::vector<std::byte> rgba;  // kCpu
  };
  explicit SourceTexture(DemosaicSite site) : site_(site) {}
  Storage& storageFor(std::uint32_t width_px, std::uint32_t height_px);

  DemosaicSite site_;
  std::optional<DemosaicPass> pass_;
  std::vector<Storage> storages_;
};

}  // namespace ui
