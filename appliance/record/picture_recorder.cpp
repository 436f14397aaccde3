#include "appliance/record/picture_recorder.h"

#include <cstdio>
#include <filesystem>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

// A still is taken of a mode's 10th picture, when the change of mode has settled. A picture's text
// comes one picture later, so the still of a stopped moment or of a view of a sweep is taken some
// pictures after it begins.
constexpr std::uint32_t kSettled = 10;
constexpr std::uint32_t kFrozenSettled = 3;
constexpr std::uint32_t kViewSettled = 2;

}  // namespace

std::expected<std::unique_ptr<PictureRecorder>, std::string> PictureRecorder::create(
    const RecordSettings& config, hal::DisplayMode mode, ui::PictureSource& source) {
  std::error_code error;
  std::filesystem::create_directories(config.directory, error);
  if (error) {
    return std::unexpected(withId(phrase<Word::kRecordFolder>(config.directory, error.message())));
  }
  auto recorder = ui::Recorder::create({.folder = config.directory,
                                        .video_width_px = config.video_width_px,
                                        .video_hz = config.video_hz},
                                       mode, source);
  if (!recorder) return std::unexpected(recorder.error());
  return std::unique_ptr<PictureRecorder>(
      new PictureRecorder(config.directory, std::move(*recorder)));
}

void PictureRecorder::onPicture(const ShownPicture& picture) noexcept {
  const PictureRecord& record = picture.record;
  ui::PictureStamp stamp{.picture_id = record.picture_id,
                         .camera = record.camera_shown,
                         .trigger = record.trigger,
                         .commit = record.commit};
  std::snprintf(stamp.mode.data(), stamp.mode.size(), "%s", nameOf(record.mode).data());
  if (picture.scene.count != 0) {
    const hal::WarpPlan& leading = picture.scene.layers[0].plan;
    stamp.H_camera_display = leading.H_camera_display;
    stamp.lens = leading.lens;
  }
  std::array<char, 32> name{};
  nameStill(record, name);
  recorder_->keep(stamp, name.data());
}

void PictureRecorder::nameStill(const PictureRecord& record, std::array<char, 32>& name) noexcept {
  pictures_in_mode_ = record.mode == mode_ ? pictures_in_mode_ + 1 : 1;
  pictures_of_view_ = record.camera_shown == view_ ? pictures_of_view_ + 1 : 1;
  mode_ = record.mode;
  view_ = record.camera_shown;
  if (record.trigger == 0 || record.substitute) return;
  bool& kept = kept_[static_cast<std::size_t>(record.mode)];
  if (record.mode == Mode::kSweep) {
    bool& view_kept = view_kept_[record.camera_shown];
    if (pictures_of_view_ < kViewSettled) return;
    if (!view_kept) {
      std::snprintf(name.data(), name.size(), "view%02u", record.camera_shown + 1);
    }
    view_kept = kept = true;
  } else if (!kept &&
             pictures_in_mode_ >= (record.mode == Mode::kFrozen ? kFrozenSettled : kSettled)) {
    std::snprintf(name.data(), name.size(), "%s", nameOf(record.mode).data());
    kept = true;
  }
}

std::expected<void, std::string> PictureRecorder::finish() {
  const auto cost = recorder_->finish();
  if (!cost) return std::unexpected(cost.error());
  const std::string path = folder_ + "/recorder.json";
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr) return std::unexpected(withId(phrase<Word::kRecordFile>(path)));
  std::fprintf(file,
               "{\"frames\": %lu, \"dropped\": %lu, \"render_thread_s\": %.6f, "
               "\"writer_cpu_s\": %.6f}\n",
               cost->frames, cost->dropped, static_cast<double>(cost->render_thread_ns) * 1e-9,
               static_cast<double>(cost->writer_cpu_ns) * 1e-9);
  if (std::fclose(file) != 0) return std::unexpected(withId(phrase<Word::kRecordFile>(path)));
  return {};
}

}  // namespace appliance
