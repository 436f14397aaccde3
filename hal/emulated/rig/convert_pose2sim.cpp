#include "hal/emulated/rig/convert_pose2sim.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include <opencv2/videoio.hpp>

#include "rt/printable.h"

namespace emulator {
namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerPixel = 64;
constexpr double kLargestSidePx = 16'384;
constexpr double kMetresPerMillimetre = 1e-3;

/// Triangulated from the four views at picture 50 of 100.
constexpr std::array<double, 3> kPelvis_m = {-1.03, -0.14, 0.87};

std::optional<std::string_view> attribute(std::string_view element, std::string_view name) {
  const std::string key = " " + std::string(name) + "=\"";
  const auto at = element.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  const auto first = at + key.size();
  const auto end = element.find('"', first);
  if (end == std::string_view::npos) return std::nullopt;
  return element.substr(first, end - first);
}

/// The attributes of one <camera> element; remembers the first that is missing or no number.
class Numbers {
 public:
  explicit Numbers(std::string_view element) : element_(element) {}
  double operator()(std::string_view name) {
    const auto text = attribute(element_, name);
    double value = 0;
    const bool ok =
        text &&
        std::from_chars(text->data(), text->data() + text->size(), value).ec == std::errc{} &&
        std::isfinite(value);
    if (!ok && missing_.empty()) missing_ = name;
    return value;
  }
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  std::string_view element_;
  std::string missing_;
};

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::expected<CameraModel, std::string> parseCamera(std::string_view element) {
  CameraModel camera;
  camera.name = attribute(element, "serial").value_or("");
  // It becomes a file's name.
  if (camera.name.empty() || !std::ranges::all_of(camera.name, isPlain))
    return std::unexpected("a camera needs a serial of letters, digits, - and _, not \"" +
                           rt::printable(camera.name) + "\"");
  Numbers number(element);
  const std::array<double, 3> centre_m = {number("x") * kMetresPerMillimetre,
                                          number("y") * kMetresPerMillimetre,
                                          number("z") * kMetresPerMillimetre};
  for (std::size_t row = 0; row < 3; ++row) {
    const double sign = row == 0 ? 1 : -1;
    for (std::size_t column = 0; column < 3; ++column) {
      const std::string name = {'r', static_cast<char>('1' + row), static_cast<char>('1' + column)};
      camera.rotation[row][column] = sign * number(name);
      camera.translation_m[row] -= camera.rotation[row][column] * centre_m[column];
    }
  }
  camera.focal_px = {number("focalLengthU") / kUnitsPerPixel,
                     number("focalLengthV") / kUnitsPerPixel};
  camera.centre_px = {number("centerPointU") / kUnitsPerPixel,
                      number("centerPointV") / kUnitsPerPixel};
  camera.distortion = {number("radialDistortion1"), number("radialDistortion2"),
                       number("tangentalDistortion1"), number("tangentalDistortion2"),
                       number("radialDistortion3")};
  const double width_px = number("right") - number("left") + 1;
  const double height_px = number("bottom") - number("top") + 1;
  if (!number.missing().empty()) {
    return std::unexpected("camera " + camera.name + " has no number " + number.missing());
  }
  if (!(width_px >= 1 && width_px <= kLargestSidePx && height_px >= 1 &&
        height_px <= kLargestSidePx)) {
    return std::unexpected("camera " + camera.name + " has a fov_marker that is no picture's size");
  }
  camera.image_size = {static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px)};
  return camera;
}

std::expected<SizePx, std::string> videoSize(const fs::path& path) {
  cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
  if (!video.isOpened()) return std::unexpected(path.string() + " cannot be read as a video");
  return SizePx{static_cast<std::uint32_t>(video.get(cv::CAP_PROP_FRAME_WIDTH)),
                static_cast<std::uint32_t>(video.get(cv::CAP_PROP_FRAME_HEIGHT))};
}

}  // namespace

std::expected<RigModel, std::string> parseQualisys(std::string_view xml) {
  RigModel rig;
  constexpr std::string_view kOpen = "<camera ";
  constexpr std::string_view kClose = "</camera>";
  for (auto at = xml.find(kOpen); at != std::string_view::npos; at = xml.find(kOpen, at)) {
    const auto end = xml.find(kClose, at);
    if (end == std::string_view::npos) return std::unexpected("a <camera> is not closed");
    auto camera = parseCamera(xml.substr(at, end - at));
    if (!camera) return std::unexpected(camera.error());
    rig.cameras.push_back(std::move(*camera));
    at = end;
  }
  if (rig.cameras.empty()) return std::unexpected("there is no <camera>: not a QTM calibration");
  return rig;
}

CameraModel letterboxed(const CameraModel& camera, SizePx video) {
  const double scale = std::min(static_cast<double>(video.width) / camera.image_size.width,
                                static_cast<double>(video.height) / camera.image_size.height);
  // Pixel centres are whole numbers: edges scale, not centres.
  const auto place = [scale](double centre, std::uint32_t from, std::uint32_t to) {
    return (centre + 0.5) * scale - 0.5 + (to - from * scale) / 2;
  };
  CameraModel fitted = camera;
  fitted.image_size = video;
  fitted.focal_px = {camera.focal_px[0] * scale, camera.focal_px[1] * scale};
  fitted.centre_px = {place(camera.centre_px[0], camera.image_size.width, video.width),
                      place(camera.centre_px[1], camera.image_size.height, video.height)};
  return fitted;
}

std::expected<RigModel, std::string> convertPose2sim(const fs::path& source,
                                                     const fs::path& destination) {
  const fs::path calibration = source / "calibration" / "Calib.qca.txt";
  std::ifstream file(calibration);
  if (!file) return std::unexpected("cannot read " + calibration.string());
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto rig = parseQualisys(text);
  if (!rig) return std::unexpected(calibration.string() + ": " + rig.error());
  rig->name = "Pose2Sim single person";
  rig->target_m = kPelvis_m;

  std::error_code error;
  fs::create_directories(destination, error);
  for (CameraModel& camera : rig->cameras) {
    const std::string name = camera.name + ".mp4";
    const auto size = videoSize(source / "videos" / name);
    if (!size) return std::unexpected(size.error());
    camera = letterboxed(camera, *size);
    // Without the source's permissions: it may be read-only, the copy is the user's own.
    fs::remove(destination / name, error);
    std::ifstream from(source / "videos" / name, std::ios::binary);
    std::ofstream to(destination / name, std::ios::binary);
    to << from.rdbuf();
    to.flush();
    if (!to) return std::unexpected("cannot write " + (destination / name).string());
  }
  if (auto written = writeRigFile(destination / "rig.toml", *rig); !written) {
    return std::unexpected(written.error());
  }
  return rig;
}

}  // namespace emulator
