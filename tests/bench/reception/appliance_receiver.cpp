#include <utility>

#include "appliance/capture/frame_history.h"
#include "hal/backends.h"
#include "tests/bench/reception/receiver.h"

namespace bench {
namespace {

class ApplianceReceiver final : public Receiver {
 public:
  explicit ApplianceReceiver(std::unique_ptr<appliance::FrameHistory> history)
      : history_(std::move(history)) {}
  ~ApplianceReceiver() override {
    for (const auto& camera : cameras_) camera->stop();
  }

  std::expected<void, std::string> add(const ReceptionSetup& setup, std::uint32_t index,
                                       appliance::CaptureBoard& board) {
    const hal::CameraProfile& profile = setup.cameras[index];
    auto camera = hal::openCamera("aravis", profile, setup.receive);
    if (!camera) return std::unexpected(camera.error());
    const auto exposure = std::chrono::duration<double, std::micro>(profile.exposure_us);
    const appliance::Association association(setup.period,
                                             std::chrono::duration_cast<rt::Nanoseconds>(exposure));
    appliance::CameraFrames& frames = history_->camera(index);
    collectors_.push_back(std::make_unique<appliance::Collector>(index, association, frames, board,
                                                                 /*trace=*/nullptr));
    cameras_.push_back(std::move(*camera));
    return cameras_.back()->start(*collectors_.back(), frames.slots(), frames.fillingSlots());
  }

  [[nodiscard]] std::uint64_t frames() const override {
    std::uint64_t frames = 0;
    for (const auto& collector : collectors_) frames += collector->counts().stored;
    return frames;
  }

 private:
  std::unique_ptr<appliance::FrameHistory> history_;
  std::vector<std::unique_ptr<appliance::Collector>> collectors_;
  std::vector<std::unique_ptr<hal::Camera>> cameras_;  // last: they call the collectors
};

}  // namespace

MadeReceiver receiveAsAppliance(const ReceptionSetup& setup, appliance::CaptureBoard& board) {
  const appliance::HistoryLayout layout{
      .frame_bytes = std::vector<std::size_t>(setup.cameras.size(), setup.frameBytes()),
      .sets = setup.sets,
      .in_flight = ReceptionSetup::kInFlight,
      .reserve = ReceptionSetup::kReserve};
  auto history = appliance::FrameHistory::create(layout);
  if (!history) return std::unexpected(history.error());
  auto receiver = std::make_unique<ApplianceReceiver>(std::move(*history));
  for (std::uint32_t i = 0; i < setup.cameras.size(); ++i) {
    if (auto added = receiver->add(setup, i, board); !added) {
      return std::unexpected(added.error());
    }
  }
  return receiver;
}

}  // namespace bench
