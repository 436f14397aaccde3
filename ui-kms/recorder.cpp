#include "ui-kms/recorder.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <utility>

#include "ui-kms/recorder_files.h"

namespace ui {
namespace {

std::int64_t threadCpuNs() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec;
}

}  // namespace

std::expected<std::unique_ptr<Recorder>, std::string> Recorder::create(const RecorderConfig& config,
                                                                       hal::DisplayMode mode,
                                                                       PictureSource& source) {
  if (config.buffers < 1 || config.buffers > kRingSize) {
    return std::unexpected("recorder buffers " + std::to_string(config.buffers) + ": give 1 to " +
                           std::to_string(kRingSize));
  }
  if (!(config.video_hz > 0) || config.video_width_px < 16) {
    return std::unexpected("recorder: video_hz must be above 0 and video_width_px at least 16");
  }
  auto files = RecorderFiles::open(config.folder, mode, config.video_width_px, config.video_hz);
  if (!files) return std::unexpected(files.error());
  std::unique_ptr<Recorder> recorder(new Recorder(config, mode, source));
  recorder->files_ = std::move(*files);
  auto thread = rt::Thread::start(
      {.name = "recorder"},
      [self = recorder.get()](const std::stop_token& stop) { self->write(stop); });
  if (!thread) return std::unexpected(std::string("recorder: ") + thread.error().where);
  recorder->thread_.thread() = std::move(*thread);
  return recorder;
}

Recorder::Recorder(const RecorderConfig& config, hal::DisplayMode mode, PictureSource& source)
    : source_(source), film_period_(std::llround(1e9 / config.video_hz)), buffers_(config.buffers) {
  for (std::uint32_t i = 0; i < config.buffers; ++i) {
    buffers_[i].resize(std::size_t{4} * mode.width_px * mode.height_px);
    static_cast<void>(free_.tryPush(i));  // the ring is as large as the most buffers
  }
}

Recorder::~Recorder() = default;

bool Recorder::filmDue(rt::Timestamp commit) {
  if (commit < next_film_) return false;
  // Absolute steps, so that the rate holds; after a pause the grid starts again.
  const bool paused = commit - next_film_ > film_period_;
  next_film_ = (paused ? commit : next_film_) + film_period_;
  return true;
}

void Recorder::keep(const PictureStamp& stamp, std::string_view still_name) {
  const bool film = filmDue(stamp.commit);
  if (!film && still_name.empty()) return;
  const rt::Timestamp begin = rt::now();
  if (tryKeep(stamp, still_name, film)) {
    ++cost_.frames;
    doorbell_.ring();
  } else {
    ++cost_.dropped;
  }
  cost_.render_thread_ns += (rt::now() - begin).count();
}

bool Recorder::tryKeep(const PictureStamp& stamp, std::string_view still_name, bool film) {
  if (!spare_) spare_ = free_.tryPop();
  if (!spare_) return false;
  if (!source_.readPicture(buffers_[*spare_])) return false;
  RecorderJob job;
  job.buffer = *spare_;
  job.film = film;
  job.stamp = stamp;
  if (const auto flip = source_.committedFlip(); flip && flip->picture_id == stamp.picture_id) {
    job.page_flip = flip->page_flip;
  }
  std::ranges::copy(still_name.substr(0, job.still.size() - 1), job.still.begin());
  if (!jobs_.tryPush(job)) return false;
  spare_.reset();
  return true;
}

void Recorder::write(const std::stop_token& stop) {
  bool last_round = false;
  while (!last_round) {
    last_round = stop.stop_requested();  // asked before the last look, so nothing is left behind
    while (const auto job = jobs_.tryPop()) {
      files_->write(*job, buffers_[job->buffer]);
      static_cast<void>(free_.tryPush(job->buffer));
    }
    if (!last_round) {
      static_cast<void>(doorbell_.waitUntil(rt::now() + std::chrono::seconds(1)));
    }
  }
  writer_cpu_ns_ = threadCpuNs();
}

std::expected<RecorderCost, std::string> Recorder::finish() {
  thread_.stop();
  cost_.writer_cpu_ns = writer_cpu_ns_;
  if (auto done = files_->finish(); !done) return std::unexpected(done.error());
  return cost_;
}

}  // namespace ui
