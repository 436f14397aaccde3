#pragma once

#include <cstdint>
#include <string>

#include "appliance/director/shot.h"

namespace appliance {

/// What the status line says.
struct StatusText {
  std::string text;      ///< utf-8
  bool warning = false;  ///< drawn as a badge: the picture is not what was asked for
};

inline constexpr const char* kStatementGap = "   ";

/// The line over the picture, as `DELAY 3.0 s   view 7/20`, with the reason where the picture
/// is not what was asked for: `camera 7 lost: showing 8`. Views are counted from 1 here.
/// Statements stand kStatementGap apart.
///
/// RT  Not safe: allocates.
[[nodiscard]] StatusText statusText(const Shot& shot, std::uint32_t cameras);

}  // namespace appliance
