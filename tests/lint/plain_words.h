#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/lint/source_tree.h"

namespace lint {

/// The words of @p text that a reader has to take twice: archaic ones, and those that hide the
/// actor. In lower case, in the order in which they stand.
[[nodiscard]] std::vector<std::string> hardWordsIn(std::string_view text);

/// What of a line of @p file people read: comments and literals of C++, everything of other files.
[[nodiscard]] std::string proseOf(const SourceFile& file, const std::string& line);

}  // namespace lint
