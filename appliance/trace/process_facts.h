#pragma once

#include <cstdint>
#include <vector>

#include "appliance/trace/records.h"

namespace appliance {

/// This process as the kernel sees it, for the record of a run.
///
/// RT  Not safe: reads /proc.
[[nodiscard]] std::vector<TracedThread> tracedThreads();
[[nodiscard]] double cpuSeconds();
[[nodiscard]] std::uint64_t residentBytes();

}  // namespace appliance
