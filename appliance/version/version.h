#pragma once

#include <string_view>

namespace appliance {

/// Which sources this program is made of: the release, and the commit that was built, for instance
/// "0.1.0 (418ee54a1b-dirty)". "-dirty": files of ours differed from the commit.
[[nodiscard]] std::string_view version();

}  // namespace appliance
