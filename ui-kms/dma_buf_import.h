#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "hal/display.h"
#include "hal/gl/objects.h"

namespace ui {

/// Stored frames as textures of one byte per pixel that are read where they are: their dma-bufs
/// imported as EGL images (EGL_EXT_image_dma_buf_import, R8, linear). A slot is imported when it is
/// first shown and stays imported.
///
/// Threads  The one that has the context current, at creation and afterwards.
/// Memory   An EGL image per slot that was ever shown; each keeps its dma-buf's pages.
/// Errors   create(): one line: what this EGL or GL does not offer.
class DmaBufImport {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<DmaBufImport>, std::string> create();
  ~DmaBufImport();
  DmaBufImport(const DmaBufImport&) = delete;
  DmaBufImport& operator=(const DmaBufImport&) = delete;

  /// A texture with the frame's bytes as they are now, good until the next call. 0 where the frame
  /// is in no dma-buf, or the driver refuses it: then it is to be uploaded.
  [[nodiscard]] GLuint tryImport(const hal::SourceImage& source);

 private:
  struct Functions;  // those of the extensions
  using Slot = std::tuple<std::uint64_t, std::size_t, std::uint32_t, std::uint32_t>;

  DmaBufImport(void* display, const Functions& functions, bool names_modifier);
  [[nodiscard]] void* imageOf(const hal::SourceImage& source);

  void* display_;  // EGLDisplay: EGL's header stays out of ours
  std::unique_ptr<const Functions> functions_;
  bool names_modifier_;
  gl::Texture texture_;
  std::map<Slot, void*> images_;  // EGLImage; none where the driver refused
};

}  // namespace ui
