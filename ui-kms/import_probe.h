#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "ui-kms/demosaic_pass.h"
#include "ui-kms/dma_buf_import.h"

namespace ui {

/// Whether frames of this size, imported, are drawn as they stand in memory, also after they have
/// been written again: one is made, imported, drawn twice and compared pixel by pixel. What EGL
/// lists is not enough: drivers have requirements for pitch and offset that they document nowhere.
///
/// Threads  The one that has the context current.
/// Errors   One line: what fails, and what to do if anything can be done.
[[nodiscard]] std::expected<void, std::string> probeImport(DmaBufImport& import, DemosaicPass& pass,
                                                           std::uint32_t width_px,
                                                           std::uint32_t height_px);

}  // namespace ui
