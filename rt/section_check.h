#pragma once

namespace rt {

/// Between section.cpp, which knows where sections are, and interpose.cpp, which
/// sees the calls. Only in the rtcheck build.
/// @return the calling thread's depth of nested sections until now
int exchangeSectionDepth(int depth) noexcept;

}  // namespace rt
