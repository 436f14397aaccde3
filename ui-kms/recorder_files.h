#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <expected>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/display.h"
#include "rt/clock.h"

namespace ui {

/// What a shown picture is, so that a kept one can be judged without the run.
struct PictureStamp {
  std::uint64_t picture_id = 0;
  std::array<char, 16> mode{};  ///< live, delayed, frozen, sweep; zero-terminated
  std::uint32_t camera = 0;     ///< from 0
  std::uint64_t trigger = 0;    ///< from 1; 0: no view was shown
  rt::Timestamp commit;
  std::array<double, 9> H_camera_display{};
  hal::Lens lens;
};

/// One picture on its way to disk; its pixels wait in the recorder's buffer of that number.
struct RecorderJob {
  std::uint32_t buffer = 0;
  bool film = false;
  PictureStamp stamp;
  std::optional<rt::Timestamp> page_flip;
  std::array<char, 32> still{};  ///< zero-terminated; empty: no still
};

/// The files of one recording, in one folder:
///   video.film      reduced pictures for encodeVideo(); its format is in film.h
///   pictures.jsonl  one JSON object per kept picture, see write()
///   NAME.png        a still at full size; NAME.rgba until finish()
///
/// Threads  One at a time.
/// Errors   finish() reports the first failed write; nothing is written after it.
class RecorderFiles {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<RecorderFiles>, std::string> open(
      const std::filesystem::path& folder, hal::DisplayMode mode, std::uint32_t film_width_px,
      double film_hz);
  ~RecorderFiles();
  RecorderFiles(const RecorderFiles&) = delete;
  RecorderFiles& operator=(const RecorderFiles&) = delete;

  void write(const RecorderJob& job, std::span<const std::byte> rgba);

  /// Closes the files and encodes the stills. Idempotent.
  [[nodiscard]] std::expected<void, std::string> finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  RecorderFiles() = default;
  [[nodiscard]] File openFile(const char* name);
  void put(std::FILE* file, const void* bytes, std::size_t size);
  void writeFilm(const RecorderJob& job, std::span<const std::byte> rgba);
  void writeStill(const RecorderJob& job, std::span<const std::byte> rgba);
  void writeLine(const RecorderJob& job);
  void encodeStill(const std::string& name);
  void fail(const std::string& what);

  std::filesystem::path folder_;
  hal::DisplayMode mode_;
  std::uint32_t film_width_px_ = 0;
  std::uint32_t film_height_px_ = 0;
  std::uint64_t film_pictures_ = 0;
  File film_;
  File lines_;
  std::vector<std::byte> reduced_;  // RGBA, then I420
  std::vector<std::byte> i420_;
  std::vector<std::string> stills_;
  std::string error_;
};

}  // namespace ui
