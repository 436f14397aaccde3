#pragma once

#include <cstddef>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/display.h"
#include "hal/gl/context.h"
#include "hal/gl/objects.h"
#include "ui-kms/demosaic_pass.h"
#include "ui-kms/dma_buf_import.h"
#include "ui-kms/render_target.h"

namespace ui {

enum class DemosaicSite : std::uint8_t {
  kAuto,  ///< the CPU under a software renderer, otherwise the GPU
  kCpu,   ///< SIMD on the calling thread, then four bytes per pixel are uploaded
  kGpu,   ///< one byte per pixel is uploaded and a shader does the rest
};

/// The shown view as a texture of linear light. Only the one view that is shown is uploaded; a GPU
/// reads it in its slot instead, where import works.
///
/// Threads  The one that has the context.
/// Memory   Storage per source size is made by prepare(), or at that size's first upload.
class SourceTexture {
 public:
  /// @p site: kCpu or kGpu.
  [[nodiscard]] static std::expected<SourceTexture, std::string> create(DemosaicSite site);

  void prepare(std::uint32_t width_px, std::uint32_t height_px);

  /// Reads frames of dma-bufs in place from now on, if a probe frame of that size comes through.
  void tryImport(const gl::Context& context, std::uint32_t width_px, std::uint32_t height_px);
  /// Why no frame is read in place; empty where those of dma-bufs are.
  [[nodiscard]] const std::string& uploadReason() const { return upload_reason_; }

  struct Loaded {
    GLuint colour = 0;      ///< holds until the next call
    bool imported = false;  ///< read in place, not uploaded
  };
  /// Demosaics. Done when it returns: nothing reads the frame any more.
  [[nodiscard]] Loaded load(const hal::SourceImage& source);

 private:
  struct Storage {
    RenderTarget colour;          // RGBA, linear light
    gl::Texture mosaic;           // kGpu
    std::vector<std::byte> rgba;  // kCpu
  };
  explicit SourceTexture(DemosaicSite site) : site_(site) {}
  Storage& storageFor(std::uint32_t width_px, std::uint32_t height_px);
  [[nodiscard]] std::expected<void, std::string> startImport(const gl::Context& context,
                                                             std::uint32_t width_px,
                                                             std::uint32_t height_px);
  void upload(GLuint texture, GLenum format, const hal::SourceImage& source, const std::byte* data);

  DemosaicSite site_;
  std::optional<DemosaicPass> pass_;
  std::unique_ptr<DmaBufImport> import_;  // where it works
  std::string upload_reason_ = "import was not tried";
  std::vector<Storage> storages_;
};

}  // namespace ui
