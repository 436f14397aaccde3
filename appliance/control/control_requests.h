#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "appliance/director/command.h"
#include "appliance/status/status.h"
#include "appliance/words/phrase.h"

/// What a request of the control interface means in the present state: pure.
/// Errors   What is wrong, for the person who asked.
namespace appliance {

using Requested = std::expected<Command, Phrase>;

/// A command that names the state, so that the same request twice changes nothing.
[[nodiscard]] Requested requestMode(std::string_view mode);
[[nodiscard]] Requested requestDelay(std::uint32_t delay_ms, const Status& now);
/// @p view counts from 1.
[[nodiscard]] Requested requestView(std::uint32_t view, const Status& now);
/// @p rate: "1", "1/2", "1/4", "1/8" or "0".
[[nodiscard]] Requested requestSpeed(std::string_view rate);
/// The last @p delay_ms once more at @p rate, which is not "0".
[[nodiscard]] Requested requestReplay(std::uint32_t delay_ms, std::string_view rate,
                                      const Status& now);
/// A second shot in the same picture. @p layout: as in kLayouts; "single" ends the comparison, and
/// nothing else counts then. @p view: of the second shot, from 1; 0: the first's.
[[nodiscard]] Requested requestCompare(std::string_view layout, std::uint32_t view,
                                       std::uint32_t earlier_ms, double share, const Status& now);
[[nodiscard]] std::expected<std::array<double, 3>, Phrase> requestTarget(double x_m, double y_m,
                                                                         double z_m);

/// Why the director refused a command, and what to do; empty: it did not.
[[nodiscard]] Phrase refusalOf(CommandOutcome outcome);

/// The text of a rig file, unless it is larger than any.
[[nodiscard]] std::expected<std::string, Phrase> requestRig(std::string_view text);

}  // namespace appliance
