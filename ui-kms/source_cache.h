#pragma once

#include <cstddef>
#include <cstdint>
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
#include "ui-kms/orientation.h"
#include "ui-kms/render_target.h"

namespace ui {

enum class DemosaicSite : std::uint8_t {
  kAuto,  ///< the CPU under a software renderer, otherwise the GPU
  kCpu,   ///< SIMD on the calling thread, then four bytes per pixel are uploaded
  kGpu,   ///< one byte per pixel is uploaded and a shader does the rest
};

/// The shown frames as textures of linear light. Only what is shown is uploaded; a GPU reads it in
/// its slot instead, where import works. A frame that is still here under its name is not loaded
/// again: a stopped moment costs its demosaicing once.
///
/// Threads  The one that has the context.
/// Memory   As many textures per source size as a scene has layers, so that no layer of a picture
///          takes the texture of another. prepare() makes them, or that size's first load().
class SourceCache {
 public:
  /// @p site: kCpu or kGpu.
  [[nodiscard]] static std::expected<SourceCache, std::string> create(DemosaicSite site);

  /// For frames of that size. Errors: one line; the graphics driver has no room.
  [[nodiscard]] std::expected<void, std::string> prepare(SizePx size);

  /// Reads frames of dma-bufs in place from now on, those of the sizes for which a probe frame
  /// comes through.
  void tryImport(const gl::Context& context, const std::vector<SizePx>& sizes);
  /// Why no frame is read in place, or those of one size are not; empty where all of dma-bufs are.
  [[nodiscard]] const std::string& uploadReason() const { return upload_reason_; }

  struct Loaded {
    GLuint colour = 0;      ///< holds until as many other frames were loaded as a scene has layers
    bool imported = false;  ///< read in place, not uploaded
  };
  /// Demosaics, or finds what was demosaiced. After finish() nothing reads the frame any more.
  /// @p content: the frame's name, as in hal::ViewLayer. Texture 0: the driver has no room.
  [[nodiscard]] Loaded load(const hal::SourceImage& source, std::uint64_t content);
  /// Waits for what load() began.
  void finish();

 private:
  struct Entry {
    RenderTarget colour;  // RGBA, linear light
    std::uint64_t content = 0;
    hal::PixelFormat format{};
    bool imported = false;
    std::uint64_t used = 0;  // counts loads: the smallest is the oldest
  };
  struct Storage {  // of one size
    SizePx size;
    bool imports = false;
    gl::Texture mosaic;           // kGpu
    std::vector<std::byte> rgba;  // kCpu
    std::vector<Entry> entries;
  };
  explicit SourceCache(DemosaicSite site) : site_(site) {}
  [[nodiscard]] Storage* storageFor(SizePx size);
  [[nodiscard]] std::expected<Storage, std::string> makeStorage(SizePx size) const;
  [[nodiscard]] std::expected<void, std::string> startImport(const gl::Context& context,
                                                             const std::vector<SizePx>& sizes);
  void demosaic(const hal::SourceImage& source, Storage& storage, Entry& entry);
  void upload(GLuint texture, GLenum format, const hal::SourceImage& source, const std::byte* data);

  DemosaicSite site_;
  std::optional<DemosaicPass> pass_;
  std::unique_ptr<DmaBufImport> import_;  // where it works
  std::string upload_reason_ = "import was not tried";
  std::vector<Storage> storages_;
  std::vector<SizePx> importable_;
  std::uint64_t loads_ = 0;
  bool unfinished_ = false;
};

}  // namespace ui
