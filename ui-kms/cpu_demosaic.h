#pragma once

#include <cstddef>
#include <span>

#include "hal/display.h"

namespace ui {

/// Full colour from one colour per pixel (bilinear), still in linear light.
/// @p rgba: width x height x 4 bytes, rows without padding; the fourth byte is 255.
///
/// Memory   None is allocated.
void demosaicOnCpu(const hal::SourceImage& source, std::span<std::byte> rgba);

}  // namespace ui
