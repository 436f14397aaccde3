#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>

#include "appliance/trace/trace_file.h"

/// A trace for people, instants in milliseconds after the trigger edge.
namespace appliance {

/// What ran and how much of everything the trace holds.
[[nodiscard]] std::string traceOverview(const Trace& trace);

/// From the pulse to the screen: the frames of a trigger, or that of one camera (from 0), and the
/// pictures that showed it. Errors: no such trigger.
[[nodiscard]] std::expected<std::string, std::string> lifeOfTrigger(
    const Trace& trace, std::uint64_t trigger, std::optional<std::uint32_t> camera);

/// One picture and the frame that it shows. Errors: no such picture.
[[nodiscard]] std::expected<std::string, std::string> lifeOfPicture(const Trace& trace,
                                                                    std::uint64_t picture_id);

}  // namespace appliance
