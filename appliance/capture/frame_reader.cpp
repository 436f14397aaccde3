#include "appliance/capture/frame_reader.h"

#include <algorithm>

#include "appliance/capture/frame_history.h"

namespace appliance {

FrameReader::FrameReader(FrameHistory& history, std::string name, std::uint32_t pins_per_camera)
    : history_(history), name_(std::move(name)), pins_per_camera_(pins_per_camera) {
  for (std::uint32_t i = 0; i < history.cameras(); ++i) budgets_.emplace_back(pins_per_camera);
}

std::optional<PinnedFrame> FrameReader::tryPin(std::uint32_t camera,
                                               std::uint64_t trigger) RT_SAFE {
  return history_.camera(camera).tryPin(trigger, budgets_[camera]);
}

ReaderReport FrameReader::report() const {
  ReaderReport report{.name = name_, .pins_per_camera = pins_per_camera_};
  for (const rt::PinBudget& budget : budgets_) {
    report.most_pinned = std::max(report.most_pinned, budget.used());
    report.refused += budget.refused();
  }
  return report;
}

}  // namespace appliance
