#include "ui-kms/recorder_files.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ui {
namespace {

cv::Mat view(const std::byte* pixels, std::uint32_t width_px, std::uint32_t height_px, int type) {
  // OpenCV has no Mat of constant pixels; these are only read.
  return {static_cast<int>(height_px), static_cast<int>(width_px), type,
          const_cast<std::byte*>(pixels)};
}

template <std::size_t N>
std::string numbers(const std::array<double, N>& values) {
  std::string text = "[";
  for (const double value : values) {
    std::array<char, 32> number{};
    // JSON knows no infinity; the greatest double stands for a radius without a limit.
    const double finite = std::clamp(value, -1e308, 1e308);
    std::snprintf(number.data(), number.size(), "%s%.17g", text.size() > 1 ? "," : "", finite);
    text += number.data();
  }
  return text + "]";
}

std::uint32_t even(double value) {
  return 2 * static_cast<std::uint32_t>(std::lround(value / 2));
}

}  // namespace

std::expected<std::unique_ptr<RecorderFiles>, std::string> RecorderFiles::open(
    const std::filesystem::path& folder, hal::DisplayMode mode, std::uint32_t film_width_px,
    double film_hz) {
  std::unique_ptr<RecorderFiles> files(new RecorderFiles);
  files->folder_ = folder;
  files->mode_ = mode;
  // I420 halves the colour both ways, so both sides are even.
  files->film_width_px_ = even(std::min(film_width_px, mode.width_px));
  files->film_height_px_ =
      even(static_cast<double>(files->film_width_px_) * mode.height_px / mode.width_px);
  const std::size_t pixels = std::size_t{files->film_width_px_} * files->film_height_px_;
  files->reduced_.resize(pixels * 4);
  files->i420_.resize(pixels * 3 / 2);
  files->film_ = files->openFile("video.film");
  files->lines_ = files->openFile("pictures.jsonl");
  if (!files->error_.empty()) return std::unexpected(files->error_);
  std::fprintf(files->film_.get(), "kagami-film 1 %u %u %g\n", files->film_width_px_,
               files->film_height_px_, film_hz);
  return files;
}

RecorderFiles::~RecorderFiles() = default;

RecorderFiles::File RecorderFiles::openFile(const char* name) {
  File file(std::fopen((folder_ / name).c_str(), "wb"));
  if (!file) fail("cannot write " + (folder_ / name).string());
  return file;
}

void RecorderFiles::fail(const std::string& what) {
  if (error_.empty()) error_ = "recorder: " + what + ": " + std::strerror(errno);
}

void RecorderFiles::put(std::FILE* file, const void* bytes, std::size_t size) {
  if (std::fwrite(bytes, 1, size, file) != size) fail("cannot write in " + folder_.string());
}

void RecorderFiles::write(const RecorderJob& job, std::span<const std::byte> rgba) {
  if (!error_.empty()) return;
  if (job.film) writeFilm(job, rgba);
  if (job.still[0] != '\0') writeStill(job, rgba);
  writeLine(job);
}

void RecorderFiles::writeFilm(const RecorderJob& job, std::span<const std::byte> rgba) {
  const cv::Mat whole = view(rgba.data(), mode_.width_px, mode_.height_px, CV_8UC4);
  cv::Mat reduced = view(reduced_.data(), film_width_px_, film_height_px_, CV_8UC4);
  cv::Mat i420 = view(i420_.data(), film_width_px_, film_height_px_ * 3 / 2, CV_8UC1);
  cv::resize(whole, reduced, reduced.size(), 0, 0, cv::INTER_AREA);
  cv::cvtColor(reduced, i420, cv::COLOR_RGBA2YUV_I420);
  const std::int64_t commit_ns = rt::toNs(job.stamp.commit);
  put(film_.get(), &commit_ns, sizeof commit_ns);
  put(film_.get(), i420_.data(), i420_.size());
  ++film_pictures_;
}

void RecorderFiles::writeStill(const RecorderJob& job, std::span<const std::byte> rgba) {
  const std::string name = job.still.data();
  const File file = openFile((name + ".rgba").c_str());
  if (!file) return;
  put(file.get(), rgba.data(), rgba.size());
  if (std::ranges::find(stills_, name) == stills_.end()) stills_.push_back(name);
}

void RecorderFiles::writeLine(const RecorderJob& job) {
  const PictureStamp& stamp = job.stamp;
  const hal::Lens& lens = stamp.lens;
  const auto quoted = [](const char* text) { return '"' + std::string(text) + '"'; };
  std::string line = "{\"picture_id\":" + std::to_string(stamp.picture_id);
  line += ",\"mode\":" + quoted(stamp.mode.data());
  line += ",\"camera\":" + std::to_string(stamp.camera);
  line += ",\"trigger\":" + std::to_string(stamp.trigger);
  line += ",\"commit_ns\":" + std::to_string(rt::toNs(stamp.commit));
  line += ",\"page_flip_ns\":" +
          (job.page_flip ? std::to_string(rt::toNs(*job.page_flip)) : std::string("null"));
  line += ",\"film_picture\":" + (job.film ? std::to_string(film_pictures_ - 1) : "null");
  line += ",\"still\":" + (job.still[0] != '\0'
                               ? quoted((std::string(job.still.data()) + ".png").c_str())
                               : std::string("null"));
  line += ",\"H_camera_display\":" + numbers(stamp.H_camera_display);
  line += ",\"focal_px\":" + numbers(std::array{lens.fx_px, lens.fy_px});
  line += ",\"centre_px\":" + numbers(std::array{lens.cx_px, lens.cy_px});
  line += ",\"distortion\":" + numbers(lens.distortion);
  line += ",\"max_radius\":" + numbers(std::array{lens.max_radius}) + "}\n";
  put(lines_.get(), line.data(), line.size());
}

void RecorderFiles::encodeStill(const std::string& name) {
  const std::filesystem::path raw = folder_ / (name + ".rgba");
  std::vector<std::byte> rgba(std::size_t{4} * mode_.width_px * mode_.height_px);
  const File file(std::fopen(raw.c_str(), "rb"));
  if (!file || std::fread(rgba.data(), 1, rgba.size(), file.get()) != rgba.size()) {
    return fail("cannot read back " + raw.string());
  }
  cv::Mat bgr;
  cv::cvtColor(view(rgba.data(), mode_.width_px, mode_.height_px, CV_8UC4), bgr,
               cv::COLOR_RGBA2BGR);
  const std::filesystem::path png = folder_ / (name + ".png");
  if (!cv::imwrite(png.string(), bgr)) return fail("cannot write " + png.string());
  std::filesystem::remove(raw);
}

std::expected<void, std::string> RecorderFiles::finish() {
  for (File* file : {&film_, &lines_}) {
    if (*file && std::fclose(file->release()) != 0) fail("cannot write in " + folder_.string());
  }
  for (const std::string& name : std::exchange(stills_, {})) encodeStill(name);
  if (!error_.empty()) return std::unexpected(error_);
  return {};
}

}  // namespace ui
