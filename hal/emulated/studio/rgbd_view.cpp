#include "hal/emulated/studio/rgbd_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>

#include "hal/emulated/studio/bytes.h"
#include "hal/emulated/studio/srgb.h"

namespace emulator::studio {
namespace {

constexpr float kExposure = 1.14f;   // light 1 is a little more than full, as for the cameras
constexpr float kNearer_m = 0.002f;  // than the hall: a person

std::uint8_t shown(float light) {
  static const auto table = [] {
    std::array<std::uint8_t, 4096> values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double v = static_cast<double>(i) / (values.size() - 1);
      values[i] = static_cast<std::uint8_t>(std::lround(255 * srgb(v)));
    }
    return values;
  }();
  const float index = std::clamp(light * kExposure, 0.0f, 1.0f) * (table.size() - 1);
  return table[static_cast<std::size_t>(std::lround(index))];
}

std::uint16_t stepsOf(float depth_m) {
  const float steps = depth_m / RgbdPatch::kStep_m + 0.5f;
  return steps < 65536 ? static_cast<std::uint16_t>(steps) : std::uint16_t{0};
}

}  // namespace

void RgbdPatch::putInto(const DepthRingWriter::Canvas& canvas) const {
  for (const PixelRun& run : runs) {
    const std::uint16_t* depth = &depth_steps[run.from];
    float* to = &canvas.depth_m[run.start];
    for (std::uint32_t i = 0; i < run.length; ++i) to[i] = static_cast<float>(depth[i]) * kStep_m;
    std::memcpy(&canvas.colour_rgb[3 * std::size_t{run.start}],
                &colour_rgb[3 * std::size_t{run.from}], 3 * std::size_t{run.length});
  }
}

void RgbdPatch::save(std::vector<std::byte>& to) const {
  const std::array counts = {static_cast<std::uint32_t>(runs.size()),
                             static_cast<std::uint32_t>(depth_steps.size())};
  putBytes(to, counts);
  putBytes(to, runs);
  putBytes(to, depth_steps);
  putBytes(to, colour_rgb);
}

std::optional<RgbdPatch> RgbdPatch::load(std::span<const std::byte>& bytes, std::size_t pixels) {
  RgbdPatch patch;
  std::array<std::uint32_t, 2> counts{};
  if (!takeBytes(bytes, counts) || counts[0] > pixels || counts[1] > pixels) return std::nullopt;
  patch.runs.resize(counts[0]);
  patch.depth_steps.resize(counts[1]);
  patch.colour_rgb.resize(3 * std::size_t{counts[1]});
  if (!takeBytes(bytes, patch.runs) || !takeBytes(bytes, patch.depth_steps) ||
      !takeBytes(bytes, patch.colour_rgb) || !fit(patch.runs, pixels, counts[1]))
    return std::nullopt;
  return patch;
}

RgbdView::RgbdView(const StudioCamera& camera, const Backdrop& backdrop)
    : width_(static_cast<int>(backdrop.width)),
      height_(static_cast<int>(backdrop.height)),
      rgb_(backdrop.rgb),
      depth_m_(backdrop.depth_m) {
  findFloor(camera);
  fillEmpty();
}

std::size_t RgbdView::savedBytes(SizePx size) {
  return std::size_t{size.width} * size.height * 4 * sizeof(float);
}

RgbdView::RgbdView(const StudioCamera& camera, std::span<const std::byte> saved)
    : width_(static_cast<int>(camera.model.image_size.width)),
      height_(static_cast<int>(camera.model.image_size.height)),
      rgb_(saved.size() / (4 * sizeof(float)) * 3),
      depth_m_(rgb_.size() / 3) {
  std::memcpy(rgb_.data(), saved.data(), rgb_.size() * sizeof(float));
  std::memcpy(depth_m_.data(), &saved[rgb_.size() * sizeof(float)],
              depth_m_.size() * sizeof(float));
  findFloor(camera);
  fillEmpty();
}

void RgbdView::save(std::vector<std::byte>& to) const {
  putBytes(to, rgb_);
  putBytes(to, depth_m_);
}

void RgbdView::findFloor(const StudioCamera& camera) {
  const Eigen::Matrix3d to_rig = camera.rotation().transpose();
  const Eigen::Vector3d eye = camera.centre();
  const CameraModel& m = camera.model;
  floor_.assign(depth_m_.size(), cv::Point2f(-1, -1));
  std::size_t i = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x, ++i) {
      const Eigen::Vector3d ray((x - m.centre_px[0]) / m.focal_px[0],
                                (y - m.centre_px[1]) / m.focal_px[1], 1);
      const Eigen::Vector3d point = eye + to_rig * ray * depth_m_[i];
      if (const auto cell = FloorShade::cellOf(point))
        floor_[i] = cv::Point2f(static_cast<float>(cell->x()), static_cast<float>(cell->y()));
    }
  }
}

void RgbdView::fillEmpty() {
  colour_empty_.resize(rgb_.size());
  std::ranges::transform(rgb_, colour_empty_.begin(), shown);
}

void RgbdView::drawEmpty(const DepthRingWriter::Canvas& canvas) const {
  std::ranges::copy(depth_m_, canvas.depth_m.begin());
  std::ranges::copy(colour_empty_, canvas.colour_rgb.begin());
}

RgbdPatch RgbdView::develop(const std::vector<PeoplePicture>& people, const FloorShade& shade,
                            const cv::Mat& depth_m) const {
  const cv::Size size(width_, height_);
  cv::Mat covers(size, CV_8UC4, cv::Scalar::all(0));
  for (const PeoplePicture& picture : people) picture.roots.copyTo(covers(picture.area));
  RgbdPatch patch;
  RunMaker runs(patch.runs);
  const auto put = [&](std::size_t i, const cv::Vec4b& light, float kept) {
    patch.depth_steps.push_back(
        stepsOf(depth_m.at<float>(static_cast<int>(i) / width_, static_cast<int>(i) % width_)));
    const float cover = static_cast<float>(light[3]) / 255;
    for (std::size_t c = 0; c < 3; ++c) {
      const float root = static_cast<float>(light[static_cast<int>(c)]) / 255;
      const float person = cover > 0 ? root * root / cover : 0;
      patch.colour_rgb.push_back(shown(rgb_[3 * i + c] * kept * (1 - cover) + person));
    }
  };
  for (int y = 0; y < height_; ++y) {
    runs.beginRow();
    for (int x = 0; x < width_; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x);
      const cv::Vec4b& light = covers.at<cv::Vec4b>(y, x);
      const float kept = floor_[i].x >= 0 ? shade.at(floor_[i].x, floor_[i].y) : 1;
      const bool nearer = depth_m.at<float>(y, x) < depth_m_[i] - kNearer_m;
      if (light[3] == 0 && kept >= FloorShade::kFaintest && !nearer) continue;
      for (std::uint32_t gap = runs.add(static_cast<std::uint32_t>(i)); gap > 0; --gap)
        put(i - gap, cv::Vec4b(0, 0, 0, 0), 1);
      put(i, light, kept);
    }
  }
  return patch;
}

}  // namespace emulator::studio
