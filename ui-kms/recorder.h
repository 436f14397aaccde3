#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/display.h"
#include "rt/clock.h"
#include "rt/doorbell.h"
#include "rt/ringed_thread.h"
#include "rt/spsc_ring.h"
#include "ui-kms/picture_source.h"
#include "ui-kms/recorder_files.h"

namespace ui {

struct RecorderConfig {
  std::filesystem::path folder;        ///< exists; gets video.film, pictures.jsonl and the stills
  std::uint32_t video_width_px = 640;  ///< the height follows from the display's shape
  double video_hz = 20;                ///< at most this many pictures per second
  std::uint32_t buffers = 6;           ///< whole pictures that may wait for the writer
};

/// What recording took from the run it recorded.
struct RecorderCost {
  std::uint64_t frames = 0;   ///< pictures kept
  std::uint64_t dropped = 0;  ///< pictures not kept because the writer was behind
  std::int64_t render_thread_ns = 0;
  std::int64_t writer_cpu_ns = 0;
};

/// Keeps shown pictures for a film and for evidence: reduced ones at a steady rate, and stills
/// at full size on request. Encoding comes after the run (film.h).
///
/// Threads  create(), finish(): the owner, before and after the render thread. keep(): the render
///          thread. Its own thread `recorder` (SCHED_OTHER) writes to disk.
/// RT       keep() reads one picture back, copies it and never waits for the writer.
/// Memory   All buffers are made by create(). With all of them in use a picture is dropped and
///          counted: the newest loses.
/// Errors   create(), finish(): one line: which file, what happened.
class Recorder {
 public:
  /// @p source outlives the recorder's last keep().
  [[nodiscard]] static std::expected<std::unique_ptr<Recorder>, std::string> create(
      const RecorderConfig& config, hal::DisplayMode mode, PictureSource& source);
  ~Recorder();

  /// Call after each commit. Keeps the picture where the film is due for one, or as the still
  /// @p still_name (letters, digits, - and _; at most 31) where one is given.
  void keep(const PictureStamp& stamp, std::string_view still_name = {});

  /// Writes what waits and turns stills into NAME.png. Idempotent.
  [[nodiscard]] std::expected<RecorderCost, std::string> finish();

 private:
  static constexpr std::uint32_t kRingSize = 16;

  Recorder(const RecorderConfig& config, hal::DisplayMode mode, PictureSource& source);
  [[nodiscard]] bool filmDue(rt::Timestamp commit);
  [[nodiscard]] bool tryKeep(const PictureStamp& stamp, std::string_view still_name, bool film);
  void write(const std::stop_token& stop);

  PictureSource& source_;
  rt::Nanoseconds film_period_;
  std::vector<std::vector<std::byte>> buffers_;
  rt::SpscRing<std::uint32_t, kRingSize> free_;  // writer -> render thread
  rt::SpscRing<RecorderJob, kRingSize> jobs_;    // render thread -> writer
  rt::Doorbell doorbell_;
  std::unique_ptr<RecorderFiles> files_;  // the writer's until it ends
  std::int64_t writer_cpu_ns_ = 0;        // the writer's, read after its end

  // The render thread's, read after its end.
  rt::Timestamp next_film_;
  RecorderCost cost_;
  std::optional<std::uint32_t> spare_;  // taken from free_, but its picture was not read

  rt::RingedThread thread_{doorbell_};  // last: ends before what it works with
};

}  // namespace ui
