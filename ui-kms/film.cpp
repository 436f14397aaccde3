#include "ui-kms/film.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace ui {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

struct SideFile {
  File file;
  unsigned width_px = 0;
  unsigned height_px = 0;
  double hz = 0;
};

struct Picture {
  std::int64_t commit_ns = 0;
  cv::Mat i420;
};

std::expected<SideFile, std::string> openSideFile(const std::filesystem::path& path) {
  SideFile side;
  side.file = File(std::fopen(path.c_str(), "rb"));
  if (!side.file) return std::unexpected("cannot open " + path.string());
  std::array<char, 96> head{};
  const bool line = std::fgets(head.data(), head.size(), side.file.get()) != nullptr;
  const int fields = line ? std::sscanf(head.data(), "kagami-film 1 %u %u %lf", &side.width_px,
                                        &side.height_px, &side.hz)
                          : 0;
  constexpr unsigned kMostPx = 16384;
  const bool sane = fields == 3 && side.width_px > 0 && side.height_px > 0 &&
                    side.width_px <= kMostPx && side.height_px <= kMostPx &&
                    side.width_px % 2 == 0 && side.height_px % 2 == 0 && side.hz > 0 &&
                    side.hz <= 1000;
  if (!sane) return std::unexpected(path.string() + " is no recording of this version");
  return side;
}

/// The next whole picture; a recording that was cut off ends at its last one.
std::optional<Picture> readPicture(const SideFile& side) {
  Picture picture;
  picture.i420.create(static_cast<int>(side.height_px) * 3 / 2, static_cast<int>(side.width_px),
                      CV_8UC1);
  const std::size_t bytes = picture.i420.total();
  if (std::fread(&picture.commit_ns, sizeof picture.commit_ns, 1, side.file.get()) != 1 ||
      std::fread(picture.i420.data, 1, bytes, side.file.get()) != bytes) {
    return std::nullopt;
  }
  return picture;
}

/// How long a picture was shown; a long absence of the screen is shortened.
double standsForS(const Picture& picture, const Picture& next) {
  constexpr double kLongestS = 10;
  return std::clamp(static_cast<double>(next.commit_ns - picture.commit_ns) * 1e-9, 0.0, kLongestS);
}

/// H.264 plays everywhere; MPEG-4 part 2 is what an ffmpeg without x264 still offers.
bool openWriter(cv::VideoWriter& writer, const std::filesystem::path& video, const SideFile& side,
                std::string& codec) {
  const cv::Size size(static_cast<int>(side.width_px), static_cast<int>(side.height_px));
  for (const char* four : {"avc1", "mp4v"}) {
    codec = four;
    if (writer.open(video.string(), cv::CAP_FFMPEG,
                    cv::VideoWriter::fourcc(four[0], four[1], four[2], four[3]), side.hz, size)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::expected<FilmReport, std::string> encodeVideo(const std::filesystem::path& side_file,
                                                   const std::filesystem::path& video) {
  const auto side = openSideFile(side_file);
  if (!side) return std::unexpected(side.error());
  auto picture = readPicture(*side);
  if (!picture) return std::unexpected(side_file.string() + " holds no picture");
  FilmReport report;
  report.hz = side->hz;
  cv::VideoWriter writer;
  if (!openWriter(writer, video, *side, report.codec)) {
    return std::unexpected("cannot encode " + video.string() +
                           ": no H.264 or MPEG-4 encoder in OpenCV's ffmpeg, or not writable");
  }
  double until_s = 0;
  cv::Mat bgr;
  while (picture) {
    ++report.pictures;
    const auto next = readPicture(*side);
    until_s += next ? standsForS(*picture, *next) : 1 / side->hz;
    cv::cvtColor(picture->i420, bgr, cv::COLOR_YUV2BGR_I420);
    while ((static_cast<double>(report.frames) + 0.5) / side->hz < until_s) {
      writer.write(bgr);
      ++report.frames;
    }
    picture = next;
  }
  writer.release();
  return report;
}

}  // namespace ui
