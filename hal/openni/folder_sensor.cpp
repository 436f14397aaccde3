#include "hal/openni/folder_sensor.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace hal::openni {

std::expected<std::unique_ptr<FolderSensor>, std::string> FolderSensor::open(
    const FolderSettings& settings) {
  auto recording = FolderRecording::open(settings.folder);
  if (!recording) return std::unexpected(recording.error());
  return std::unique_ptr<FolderSensor>(new FolderSensor(settings, std::move(*recording)));
}

FolderSensor::FolderSensor(FolderSettings settings, FolderRecording recording)
    : settings_(std::move(settings)), recording_(std::move(recording)) {
  status_.name = recording_.name();
  status_.width_px = recording_.width_px();
  status_.height_px = recording_.height_px();
  status_.colour = recording_.colour();
}

DepthStatus FolderSensor::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

bool FolderSensor::readNext() {
  const auto& entries = recording_.entries();
  // A folder without one picture that can be read ends, instead of being searched forever.
  for (std::size_t tried = 0; tried <= entries.size(); ++tried) {
    if (next_ == entries.size()) {
      if (!settings_.repeat) return false;
      next_ = 0;
      last_number_.reset();
      clock_ = {};
    }
    const FolderRecording::Entry& entry = entries[next_++];
    auto pictures = recording_.read(entry);
    const std::scoped_lock lock(mutex_);
    if (!pictures) {
      status_.message = pictures.error();
      continue;
    }
    if (!pictures->remark.empty()) status_.message = pictures->remark;
    if (last_number_) status_.lost += entry.number - *last_number_ - 1;
    last_number_ = entry.number;
    if (status_.colour && pictures->colour_rgb.empty()) ++status_.without_colour;
    ready_ = Ready{&entry, std::move(*pictures), clock_.due(entry.stamp_us, rt::now())};
    return true;
  }
  return false;
}

std::optional<DepthFrame> FolderSensor::waitFrame(rt::Nanoseconds timeout) {
  const rt::Timestamp until = rt::now() + timeout;
  if (!ready_ && !readNext()) {
    {
      const std::scoped_lock lock(mutex_);
      status_.state = DepthState::kEnded;
    }
    std::this_thread::sleep_until(until);
    return std::nullopt;
  }
  if (settings_.play == Play::kRealTime && ready_->exposure > rt::now()) {
    std::this_thread::sleep_until(std::min(ready_->exposure, until));
    if (ready_->exposure > rt::now()) return std::nullopt;
  }
  lent_ = std::move(*ready_);
  ready_.reset();
  {
    const std::scoped_lock lock(mutex_);
    status_.state = DepthState::kStreaming;
    ++status_.frames;
  }
  return DepthFrame{
      .depth_mm = lent_.pictures.depth_mm,
      .colour_rgb = lent_.pictures.colour_rgb,
      .width_px = recording_.width_px(),
      .height_px = recording_.height_px(),
      .lens = recording_.lens(),
      .colour_lens = recording_.lens(),
      .number = lent_.entry->number,
      .exposure = lent_.exposure,
      .colour_exposure = lent_.pictures.colour_rgb.empty() ? rt::Timestamp{} : lent_.exposure,
      .frame_ready = rt::now()};
}

}  // namespace hal::openni
