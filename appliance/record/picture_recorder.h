#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>

#include "appliance/geometry/rig.h"
#include "appliance/record/record_settings.h"
#include "appliance/render/picture_observer.h"
#include "ui-kms/picture_source.h"
#include "ui-kms/recorder.h"

namespace appliance {

/// Keeps what was shown: a film, one still of each mode once it has settled,
/// and one of each view that a sweep passes.
///
/// Threads  As ui::Recorder: create() and finish() the owner, onPicture() the render thread.
class PictureRecorder final : public PictureObserver {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<PictureRecorder>, std::string> create(
      const RecordSettings& config, hal::DisplayMode mode, ui::PictureSource& source);

  void onPicture(const ShownPicture& picture) noexcept override;

  /// Writes everything out, then how much recording cost, as recorder.json.
  [[nodiscard]] std::expected<void, std::string> finish();

 private:
  PictureRecorder(std::string folder, std::unique_ptr<ui::Recorder> recorder)
      : folder_(std::move(folder)), recorder_(std::move(recorder)) {}
  /// Leaves @p name empty where no still is due.
  void nameStill(const PictureRecord& record, std::array<char, 32>& name) noexcept;

  std::string folder_;
  std::unique_ptr<ui::Recorder> recorder_;

  // The render thread's.
  Mode mode_ = Mode::kLive;
  std::uint32_t pictures_in_mode_ = 0;
  std::uint32_t view_ = 0;  // the last picture's
  std::uint32_t pictures_of_view_ = 0;
  std::array<bool, kModes.size()> kept_{};     // a still of that mode exists
  std::array<bool, kMaxCameras> view_kept_{};  // a still of that view exists, from a sweep
};

}  // namespace appliance
