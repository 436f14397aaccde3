#include "ui-kms/import_probe.h"

#include <cstring>
#include <vector>

#include <unistd.h>

#include "rt/dma_buf.h"
#include "rt/memory.h"
#include "ui-kms/render_target.h"

namespace ui {
namespace {

std::string sentence(const rt::Error& error) {
  std::string text = error.where;
  if (error.os_errno != 0) text += std::string(": ") + std::strerror(error.os_errno);
  if (error.code == rt::Errc::kNotPermitted) return text + ": give the user access to it";
  if (text.starts_with("/dev/udmabuf")) return text + ": load the kernel module udmabuf";
  return text;
}

/// Neighbours differ, and so do the same places of two rounds.
void fill(std::span<std::byte> pixels, std::uint32_t round) {
  std::uint32_t state = 0x9E3779B9U * (round + 1);
  for (std::byte& pixel : pixels) {
    state = state * 1664525U + 1013904223U;  // Numerical Recipes' generator
    pixel = static_cast<std::byte>(state >> 24U);
  }
}

std::size_t countWrong(std::span<const std::byte> pixels, const RenderTarget& drawn) {
  std::vector<std::byte> rgba(4 * pixels.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn.framebuffer.get());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, static_cast<GLsizei>(drawn.width_px), static_cast<GLsizei>(drawn.height_px),
               GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (rgba[4 * i] != pixels[i]) ++wrong;
  }
  return wrong;
}

}  // namespace

std::expected<void, std::string> probeImport(DmaBufImport& import, DemosaicPass& pass,
                                             std::uint32_t width_px, std::uint32_t height_px) {
  // The frame is the second of two, as most are: the driver must respect where it begins.
  const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t frame_bytes = std::size_t{width_px} * height_px;
  const std::size_t slot_bytes = (frame_bytes + page_bytes - 1) / page_bytes * page_bytes;
  const auto arena = rt::LockedArena::create(2 * slot_bytes, 0, rt::ArenaBacking::kMemoryFile);
  if (!arena) return std::unexpected(sentence(arena.error()));
  const auto buffer = rt::DmaBuf::create(arena->memoryFile(), 0, 2 * slot_bytes);
  if (!buffer) return std::unexpected(sentence(buffer.error()));

  const std::span<std::byte> pixels = arena->bytes().subspan(slot_bytes, frame_bytes);
  const hal::SourceImage source{.pixels = pixels.data(),
                                .width_px = width_px,
                                .height_px = height_px,
                                .format = hal::PixelFormat::kMono8,  // drawn as it is
                                .dma_buf = buffer->part(slot_bytes)};
  const auto target = makeRenderTarget(width_px, height_px);
  if (!target) return std::unexpected(target.error());
  const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px);
  for (std::uint32_t round = 0; round < 2; ++round) {
    fill(pixels, round);
    const GLuint texture = import.tryImport(source);
    if (texture == 0) return std::unexpected("the driver imports no frame of " + size);
    pass.draw(texture, source.format, *target);
    if (const std::size_t wrong = countWrong(pixels, *target); wrong != 0) {
      return std::unexpected("an imported frame of " + size + " is drawn with " +
                             std::to_string(wrong) + " wrong pixels");
    }
  }
  return {};
}

}  // namespace ui
