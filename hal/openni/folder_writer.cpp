#include "hal/openni/folder_writer.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <iomanip>
#include <system_error>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hal::openni {
namespace {

namespace fs = std::filesystem;

bool save(const fs::path& file, const cv::Mat& image, const std::vector<int>& how) {
  try {
    return cv::imwrite(file.string(), image, how);
  } catch (const cv::Exception&) {
    return false;
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace

std::expected<void, std::string> FolderWriter::begin(const DepthFrame& frame,
                                                     const std::string& name) {
  std::error_code failed;
  if (fs::exists(folder_, failed) && !fs::is_empty(folder_, failed))
    return std::unexpected(folder_.string() + ": is not empty: give a new folder");
  fs::create_directories(folder_ / "depth", failed);
  fs::create_directories(folder_ / "colour", failed);
  std::ofstream sensor(folder_ / "sensor.toml");
  sensor << std::setprecision(12) << "format = 1\nname = " << quoted(name) << "\nsize_px = ["
         << frame.width_px << ", " << frame.height_px << "]\nfocal_px = [" << frame.lens.focal_x_px
         << ", " << frame.lens.focal_y_px << "]\ncentre_px = [" << frame.lens.centre_x_px << ", "
         << frame.lens.centre_y_px << "]\n";
  if (frame.lens.distortion != DepthLens{}.distortion) {
    const auto& k = frame.lens.distortion;
    sensor << "distortion = [" << k[0] << ", " << k[1] << ", " << k[2] << ", " << k[3] << ", "
           << k[4] << "]\n";
  }
  stamps_.open(folder_ / "stamps.csv");
  stamps_ << "number,stamp_us\n";
  first_ = frame.exposure;
  if (sensor.flush() && stamps_) return {};
  return std::unexpected(folder_.string() + ": cannot be written: check its place and the disk");
}

std::expected<void, std::string> FolderWriter::write(const DepthFrame& frame,
                                                     const std::string& name) {
  if (written_ == 0) {
    if (auto begun = begin(frame, name); !begun) return begun;
  }
  std::array<char, 24> stem{};
  (void)std::snprintf(stem.data(), stem.size(), "%06llu",
                      static_cast<unsigned long long>(frame.number));
  const int rows = static_cast<int>(frame.height_px);
  const int columns = static_cast<int>(frame.width_px);
  // OpenCV only reads through these.
  const cv::Mat depth(rows, columns, CV_16UC1, const_cast<std::uint16_t*>(frame.depth_mm.data()));
  const std::vector<int> fast = {cv::IMWRITE_PNG_COMPRESSION, 1};
  bool done = save(folder_ / "depth" / (std::string(stem.data()) + ".png"), depth, fast);
  if (!frame.colour_rgb.empty()) {
    const cv::Mat rgb(rows, columns, CV_8UC3, const_cast<std::uint8_t*>(frame.colour_rgb.data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    const bool jpeg = colour_ == ColourFile::kJpeg;
    const fs::path file =
        folder_ / "colour" / (std::string(stem.data()) + (jpeg ? ".jpg" : ".png"));
    done = done && save(file, bgr, jpeg ? std::vector<int>{cv::IMWRITE_JPEG_QUALITY, 90} : fast);
  }
  const auto stamp = std::chrono::duration_cast<std::chrono::microseconds>(frame.exposure - first_);
  stamps_ << frame.number << ',' << stamp.count() << '\n';
  if (!done || !stamps_.flush())
    return std::unexpected(folder_.string() + ": cannot be written any further: is the disk full?");
  ++written_;
  return {};
}

}  // namespace hal::openni
