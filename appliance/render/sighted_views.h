#pragma once

#include <cstdint>

#include "appliance/director/stored_views.h"
#include "appliance/geometry/view_set.h"

namespace appliance {

/// The stored views, and which of them have the target of the last picture in theirs.
///
/// Threads  The render thread.
/// RT       RT safe.
/// Memory   Both outlive it.
class SightedViews final : public StoredViews {
 public:
  SightedViews(const StoredViews& stored, const ViewSet& views) : stored_(stored), views_(views) {}

  [[nodiscard]] std::uint32_t cameras() const RT_SAFE override { return stored_.cameras(); }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const RT_SAFE override {
    return stored_.range(camera);
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE override {
    return stored_.holds(camera, trigger);
  }
  [[nodiscard]] bool living(std::uint32_t camera) const RT_SAFE override {
    return stored_.living(camera);
  }
  [[nodiscard]] std::uint64_t heldTrigger() const RT_SAFE override { return stored_.heldTrigger(); }
  [[nodiscard]] bool sees(std::uint32_t camera) const RT_SAFE override {
    return views_.sight(camera) != Sight::kNone;
  }

 private:
  const StoredViews& stored_;
  const ViewSet& views_;
};

}  // namespace appliance
