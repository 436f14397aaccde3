#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <span>
#include <string>

namespace ui {

/// Format of a recording's side file: one line `kagami-film 1 WIDTH HEIGHT HZ`, then per picture
/// its commit instant (int64, nanoseconds, host byte order) and its pixels as I420 planes.

struct FilmReport {
  std::uint64_t pictures = 0;  ///< read from the side file
  std::uint64_t frames = 0;    ///< written to the video
  double hz = 0;
  std::string codec;  ///< the four letters in the file
};

/// Encodes @p side_file as a video of constant rate in which every picture stands for as long as
/// it stood on the screen: a picture that was dropped shows as a longer one before it.
///
/// Errors  One line: which file, what is wrong with it; or no encoder.
[[nodiscard]] std::expected<FilmReport, std::string> encodeVideo(
    const std::filesystem::path& side_file, const std::filesystem::path& video);

struct CaptionedStill {
  std::filesystem::path png;
  std::string caption;
};

/// One sheet of all stills, each with its caption below. @p font_path as for the status line.
[[nodiscard]] std::expected<void, std::string> contactSheet(std::span<const CaptionedStill> stills,
                                                            const std::filesystem::path& sheet,
                                                            const std::string& font_path = {});

}  // namespace ui
