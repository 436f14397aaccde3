#include "hal/openni/folder_writer.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <iomanip>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "rt/unique_fd.h"

namespace hal::openni {
namespace {

namespace fs = std::filesystem;
using Done = std::expected<void, std::string>;

std::unexpected<std::string> cannotWrite(const fs::path& file, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  return std::unexpected(
      file.string() + ": cannot be written (" + std::generic_category().message(error) +
      "): " + (full ? "make room on its disk" : "give a folder that can be written"));
}

/// Writes @p bytes into @p file. @p how: O_TRUNC from its beginning, O_APPEND at its end.
Done put(const fs::path& file, int how, std::string_view bytes) {
  const rt::UniqueFd out(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0666));
  if (!out.valid()) return cannotWrite(file, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(out.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return cannotWrite(file, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

/// OpenCV's own writing of files does not notice a disk that is full.
Done save(const fs::path& file, const cv::Mat& image, const std::vector<int>& how) {
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(file.extension().string(), image, bytes, how)) bytes.clear();
  } catch (const cv::Exception&) {
    bytes.clear();
  }
  if (bytes.empty()) return std::unexpected(file.string() + ": the picture cannot be encoded");
  return put(file, O_TRUNC, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string sensorText(const DepthFrame& frame, const std::string& sensor) {
  std::ostringstream text;
  text << std::setprecision(12) << "format = 1\nname = " << quoted(sensor) << "\nsize_px = ["
       << frame.width_px << ", " << frame.height_px << "]\nfocal_px = [" << frame.lens.focal_x_px
       << ", " << frame.lens.focal_y_px << "]\ncentre_px = [" << frame.lens.centre_x_px << ", "
       << frame.lens.centre_y_px << "]\n";
  if (frame.lens.distortion != DepthLens{}.distortion) {
    const auto& k = frame.lens.distortion;
    text << "distortion = [" << k[0] << ", " << k[1] << ", " << k[2] << ", " << k[3] << ", " << k[4]
         << "]\n";
  }
  return text.str();
}

const std::vector<int> kFastPng = {cv::IMWRITE_PNG_COMPRESSION, 1};

}  // namespace

Done FolderWriter::begin(const DepthFrame& frame, const std::string& sensor) {
  std::error_code failed;
  if (fs::exists(folder_, failed) && !fs::is_empty(folder_, failed))
    return std::unexpected(folder_.string() + ": is not empty: give a new folder");
  for (const char* pictures : {"depth", "colour"}) {
    fs::create_directories(folder_ / pictures, failed);
    if (failed) return cannotWrite(folder_, failed.value());
  }
  first_ = frame.exposure;
  if (auto done = put(folder_ / "sensor.toml", O_TRUNC, sensorText(frame, sensor)); !done)
    return done;
  return put(folder_ / "stamps.csv", O_TRUNC, "number,stamp_us\n");
}

Done FolderWriter::writeColour(const DepthFrame& frame, const std::string& stem) {
  if (frame.colour_rgb.empty()) return {};
  // OpenCV only reads through this.
  const cv::Mat rgb(static_cast<int>(frame.height_px), static_cast<int>(frame.width_px), CV_8UC3,
                    const_cast<std::uint8_t*>(frame.colour_rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  if (colour_ == ColourFile::kJpeg)
    return save(folder_ / "colour" / (stem + ".jpg"), bgr, {cv::IMWRITE_JPEG_QUALITY, 90});
  return save(folder_ / "colour" / (stem + ".png"), bgr, kFastPng);
}

Done FolderWriter::write(const DepthFrame& frame, const std::string& sensor) {
  if (written_ == 0) {
    if (auto begun = begin(frame, sensor); !begun) return begun;
  }
  std::array<char, 24> stem{};
  (void)std::snprintf(stem.data(), stem.size(), "%06llu",
                      static_cast<unsigned long long>(frame.number));
  // As above.
  const cv::Mat depth(static_cast<int>(frame.height_px), static_cast<int>(frame.width_px), CV_16UC1,
                      const_cast<std::uint16_t*>(frame.depth_mm.data()));
  auto done = save(folder_ / "depth" / (std::string(stem.data()) + ".png"), depth, kFastPng);
  if (done) done = writeColour(frame, stem.data());
  const auto stamp = std::chrono::duration_cast<std::chrono::microseconds>(frame.exposure - first_);
  const std::string row = std::to_string(frame.number) + "," + std::to_string(stamp.count()) + "\n";
  if (done) done = put(folder_ / "stamps.csv", O_APPEND, row);
  if (done) ++written_;
  return done;
}

}  // namespace hal::openni
