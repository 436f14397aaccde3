#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "rt/clock.h"

namespace hal::openni {

/// Writes into the header of a recording that OpenNI2 has just begun how many streams it has.
/// OpenNI2's own thread writes the number of streams that it knows when it starts, possibly before
/// all are attached, and corrects it only at the end. Without this a recording without a clean end
/// could not be played (OpenNI2 2.2, OniRecorder.cpp: attachStream() and onInitialize()).
///
/// Waits up to @p patience for the header. Errors: one line that begins with the path.
[[nodiscard]] std::expected<void, std::string> writeStreamCount(const std::string& path,
                                                                std::uint32_t count,
                                                                rt::Nanoseconds patience);

}  // namespace hal::openni
