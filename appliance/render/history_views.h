#pragma once

#include <cstdint>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/frame_history.h"
#include "appliance/director/stored_views.h"

namespace appliance {

/// The frame history as the director sees it.
///
/// Threads  The render thread.
/// RT       RT safe.
class HistoryViews final : public StoredViews {
 public:
  HistoryViews(const FrameHistory& history, const EdgeBoard& edges)
      : history_(history), edges_(edges) {}

  [[nodiscard]] std::uint32_t cameras() const RT_SAFE override { return history_.cameras(); }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const RT_SAFE override;
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE override;
  [[nodiscard]] bool living(std::uint32_t camera) const RT_SAFE override;

 private:
  const FrameHistory& history_;
  const EdgeBoard& edges_;
};

}  // namespace appliance
