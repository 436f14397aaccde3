#include "rt/section.h"

#include <utility>

#include "rt/section_check.h"

#ifdef KAGAMI_RTCHECK

namespace rt {
namespace {

constinit thread_local int section_depth = 0;

}  // namespace

int exchangeSectionDepth(int depth) noexcept {
  return std::exchange(section_depth, depth);
}

ScopedRtSection::ScopedRtSection() noexcept {
  ++section_depth;
}
ScopedRtSection::~ScopedRtSection() {
  --section_depth;
}

ScopedRtExemption::ScopedRtExemption(const char* /*reason*/) noexcept
    : suspended_depth_(exchangeSectionDepth(0)) {}
ScopedRtExemption::~ScopedRtExemption() {
  exchangeSectionDepth(suspended_depth_);
}

}  // namespace rt

#endif
