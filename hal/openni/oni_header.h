#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "rt/clock.h"

namespace hal::openni {

/// Writes into the header of a recording that OpenNI2 has just begun how many streams it has.
/// OpenNI2's own thread puts there what it finds when it comes to it, which may be before all are
/// attached, and corrects that at the end only: a recording without a clean end could then not be
/// played (OpenNI2 2.2, OniRecorder.cpp: attachStream() and onInitialize()).
///
/// Waits up to @p patience for the header. Errors: one line that begins with the path.
[[nodiscard]] std::expected<void, std::string> writeStreamCount(const std::string& path,
                                                                std::uint32_t count,
                                                                rt::Nanoseconds patience);

}  // namespace hal::openni
