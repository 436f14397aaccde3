#include "hal/emulated/rig/picture_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace emulator {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kVideoEndings = {".mp4", ".mkv", ".avi", ".mov"};
constexpr std::array<const char*, 3> kPictureEndings = {".png", ".jpg", ".jpeg"};

std::array<std::uint8_t, 256> makeLinear() {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double s = static_cast<double>(i) / 255;  // IEC 61966-2-1
    const double light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    table[i] = static_cast<std::uint8_t>(std::lround(light * 255));
  }
  return table;
}

/// Keeps of each pixel the one colour that a BayerRG sensor has there.
void appendMosaic(const cv::Mat& bgr, std::vector<std::uint8_t>& out) {
  static const auto linear = makeLinear();
  constexpr int kBlue = 0;
  constexpr int kGreen = 1;
  constexpr int kRed = 2;
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* row = bgr.ptr<cv::Vec3b>(y);
    const int even = y % 2 == 0 ? kRed : kGreen;
    const int odd = y % 2 == 0 ? kGreen : kBlue;
    for (int x = 0; x < bgr.cols; ++x) out.push_back(linear[row[x][x % 2 == 0 ? even : odd]]);
  }
}

/// Gives one picture after the other; an empty one ends them.
class PictureSource {
 public:
  static std::expected<PictureSource, std::string> open(const fs::path& folder,
                                                        const std::string& camera) {
    PictureSource source;
    const fs::path base = folder / camera;
    std::error_code error;
    if (fs::is_directory(base, error)) {
      for (const auto& entry : fs::directory_iterator(base, error)) {
        if (std::ranges::count(kPictureEndings, entry.path().extension()) > 0) {
          source.files_.push_back(entry.path());
        }
      }
      std::ranges::sort(source.files_);
      if (source.files_.empty()) {
        return std::unexpected(base.string() + " holds no .png or .jpg pictures");
      }
      source.name_ = base.string();
      return source;
    }
    for (const char* ending : kVideoEndings) {
      const fs::path video = folder / (camera + ending);
      if (!fs::exists(video, error)) continue;
      if (!source.video_.open(video.string(), cv::CAP_FFMPEG)) {
        return std::unexpected(video.string() + " cannot be read as a video");
      }
      source.name_ = video.string();
      return source;
    }
    return std::unexpected(folder.string() + " has neither a folder " + camera +
                           "/ of pictures nor a video " + camera + ".mp4 (.mkv, .avi, .mov)");
  }

  [[nodiscard]] const std::string& name() const { return name_; }

  std::expected<cv::Mat, std::string> next() {
    cv::Mat picture;
    if (files_.empty()) {
      video_.read(picture);
      return picture;
    }
    if (at_ == files_.size()) return picture;
    const fs::path& file = files_[at_++];
    picture = cv::imread(file.string(), cv::IMREAD_COLOR);
    if (picture.empty()) return std::unexpected(file.string() + " cannot be read as a picture");
    return picture;
  }

 private:
  std::string name_;
  std::vector<fs::path> files_;
  std::size_t at_ = 0;
  cv::VideoCapture video_;
};

}  // namespace

std::expected<std::vector<std::uint8_t>, std::string> readPictures(const fs::path& folder,
                                                                   const std::string& camera,
                                                                   SizePx size,
                                                                   std::size_t max_bytes) {
  auto source = PictureSource::open(folder, camera);
  if (!source) return std::unexpected(source.error());
  const std::size_t picture_bytes = std::size_t{size.width} * size.height;
  std::vector<std::uint8_t> pictures;
  while (true) {
    const auto picture = source->next();
    if (!picture) return std::unexpected(picture.error());
    if (picture->empty()) break;
    if (picture->cols != static_cast<int>(size.width) ||
        picture->rows != static_cast<int>(size.height)) {
      return std::unexpected(source->name() + " has pictures of " + std::to_string(picture->cols) +
                             "x" + std::to_string(picture->rows) + ", but rig.toml says " +
                             std::to_string(size.width) + "x" + std::to_string(size.height));
    }
    if (pictures.size() + picture_bytes > max_bytes) {
      return std::unexpected(
          source->name() + ": the recording needs more than " + std::to_string(max_bytes >> 20) +
          " MiB, its share of half of the free memory; cut it shorter or use fewer cameras");
    }
    appendMosaic(*picture, pictures);
  }
  if (pictures.empty()) return std::unexpected(source->name() + " holds no picture");
  return pictures;
}

}  // namespace emulator
