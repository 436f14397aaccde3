#include "hal/emulated/studio/sensor_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/bytes.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

/// Light 1 in the middle of the picture gives this, before the colour response.
constexpr float kFullScale_dn = 290;
constexpr float kSignalScale = 128;
constexpr float kRippleScale = 400;
constexpr float kFloorScale = 128;

/// Normal values to draw from: mean 0, deviation 1.
const std::array<float, 65536>& normals() {
  static const auto table = [] {
    std::array<float, 65536> values;
    Random random(0x5eed);
    for (float& v : values) v = static_cast<float>(random.normal());
    return values;
  }();
  return table;
}

/// The values of one row of one picture.
class RowNoise {
 public:
  RowNoise(std::uint32_t camera, std::uint64_t picture, int row) {
    Random random((std::uint64_t{camera} << 48) ^ (picture << 16) ^
                  static_cast<std::uint64_t>(row));
    state_ = static_cast<std::uint32_t>(random.next()) | 1;
  }
  [[nodiscard]] float next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return normals()[state_ >> 16];
  }

 private:
  std::uint32_t state_;
};

/// Which of red, green, blue a pixel of a BayerRG sensor sees.
std::size_t colourAt(int x, int y) {
  return y % 2 == 0 ? (x % 2 == 0 ? 0 : 1) : (x % 2 == 0 ? 1 : 2);
}

float crest(std::uint32_t variant) {
  return variant % 2 == 0 ? 1.0f : -1.0f;  // 100 Hz seen 40 times a second
}

}  // namespace

SensorView::SensorView(const StudioCamera& camera, std::uint32_t number, const Backdrop& backdrop)
    : camera_(camera),
      number_(number),
      width_(static_cast<int>(backdrop.width)),
      height_(static_cast<int>(backdrop.height)),
      pixels_(std::size_t{backdrop.width} * backdrop.height) {
  const Eigen::Matrix3d to_rig = camera.rotation().transpose();
  const Eigen::Vector3d eye = camera.centre();
  const auto& m = camera.model;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x);
      const std::size_t c = colourAt(x, y);
      const double light = backdrop.rgb[3 * i + c] * camera.falloff(x, y) * camera.response[c];
      Pixel& pixel = pixels_[i];
      pixel.signal = static_cast<std::uint16_t>(
          std::clamp(light * kFullScale_dn * kSignalScale, 0.0, 65535.0));
      pixel.ripple =
          static_cast<std::int8_t>(std::clamp(backdrop.ripple[i] * kRippleScale, -127.0f, 127.0f));
      // The lens undone, by the iteration that converges for mild lenses.
      const double dx = (x - m.centre_px[0]) / m.focal_px[0];
      const double dy = (y - m.centre_px[1]) / m.focal_px[1];
      double u = dx;
      double v = dy;
      for (int k = 0; k < 6; ++k) {
        const double r2 = u * u + v * v;
        const double radial = 1 + r2 * (m.distortion[0] + r2 * m.distortion[1]);
        const double tx = 2 * m.distortion[2] * u * v + m.distortion[3] * (r2 + 2 * u * u);
        const double ty = m.distortion[2] * (r2 + 2 * v * v) + 2 * m.distortion[3] * u * v;
        u = (dx - tx) / radial;
        v = (dy - ty) / radial;
      }
      const Eigen::Vector3d point = eye + to_rig * Eigen::Vector3d(u, v, 1) * backdrop.depth_m[i];
      if (const auto cell = FloorShade::cellOf(point)) {
        pixel.floor_x = static_cast<std::uint16_t>(cell->x() * kFloorScale);
        pixel.floor_y = static_cast<std::uint16_t>(cell->y() * kFloorScale);
      }
    }
  }
}

std::size_t SensorView::savedBytes(SizePx size) {
  return std::size_t{size.width} * size.height * sizeof(Pixel);
}

SensorView::SensorView(const StudioCamera& camera, std::uint32_t number,
                       std::span<const std::byte> saved)
    : camera_(camera),
      number_(number),
      width_(static_cast<int>(camera.model.image_size.width)),
      height_(static_cast<int>(camera.model.image_size.height)),
      pixels_(saved.size() / sizeof(Pixel)) {
  std::memcpy(pixels_.data(), saved.data(), saved.size());
}

void SensorView::save(std::vector<std::byte>& to) const {
  putBytes(to, pixels_);
}

float SensorView::signalOf(const Pixel& pixel, std::uint32_t variant) const {
  return static_cast<float>(pixel.signal) / kSignalScale *
         (1 + crest(variant) * static_cast<float>(pixel.ripple) / kRippleScale);
}

std::uint8_t SensorView::digitise(float signal_dn, float normal) const {
  const auto read = static_cast<float>(camera_.read_noise_dn);
  const float deviation =
      std::sqrt(read * read + signal_dn / static_cast<float>(camera_.electrons_per_dn));
  return static_cast<std::uint8_t>(std::clamp(signal_dn + deviation * normal + 0.5f, 0.0f, 255.0f));
}

std::vector<std::uint8_t> SensorView::background(std::uint32_t variant) const {
  std::vector<std::uint8_t> picture(pixels_.size());
  std::size_t i = 0;
  for (int y = 0; y < height_; ++y) {
    RowNoise noise(number_, variant, y);
    for (int x = 0; x < width_; ++x, ++i)
      picture[i] = digitise(signalOf(pixels_[i], variant), noise.next());
  }
  return picture;
}

/// The part of the picture in which the floor may be shaded.
cv::Rect SensorView::shadedArea(const FloorShade& shade) const {
  cv::Mat dark = shade.share < FloorShade::kFaintest;
  const cv::Rect cells = cv::boundingRect(dark);
  if (cells.empty()) return {};
  Eigen::AlignedBox2d box;
  for (int i = 0; i <= 8; ++i) {
    for (int k = 0; k <= 8; ++k) {
      const Eigen::Vector3d point(
          FloorShade::kLowX_m + FloorShade::kStep_m * (cells.x + cells.width * i / 8.0),
          FloorShade::kLowY_m + FloorShade::kStep_m * (cells.y + cells.height * k / 8.0), 0);
      const double depth = (camera_.rotation().row(2) * (point - camera_.centre()))(0);
      if (depth < 0.5) return {0, 0, width_, height_};
      box.extend(camera_.project(point));
    }
  }
  const auto bound = [](double v) { return static_cast<int>(std::clamp(v, -1e4, 1e4)); };
  return cv::Rect(cv::Point(bound(box.min().x()) - 4, bound(box.min().y()) - 4),
                  cv::Point(bound(box.max().x()) + 4, bound(box.max().y()) + 4)) &
         cv::Rect(0, 0, width_, height_);
}

Patch SensorView::develop(std::uint64_t moment, const std::vector<PeoplePicture>& people,
                          const FloorShade& shade) const {
  const auto variant = static_cast<std::uint32_t>(moment % kVariants);
  const cv::Rect shaded = shadedArea(shade);
  cv::Rect all = shaded;
  for (const PeoplePicture& picture : people) all |= picture.area;
  Patch patch;
  RunMaker runs(patch.runs);
  const auto share = [&](const Pixel& pixel) {
    return shade.at(static_cast<float>(pixel.floor_x) / kFloorScale,
                    static_cast<float>(pixel.floor_y) / kFloorScale);
  };
  for (int y = all.y; y < all.br().y; ++y) {
    RowNoise noise(number_, kVariants + moment, y);
    struct Piece {
      int first;
      int last;
      const cv::Vec4b* light;
    };
    std::array<Piece, 16> pieces;
    std::size_t count = 0;
    for (const PeoplePicture& picture : people) {
      if (y < picture.area.y || y >= picture.area.br().y || count == pieces.size()) continue;
      pieces[count++] = {picture.area.x, picture.area.br().x,
                         picture.roots.ptr<cv::Vec4b>(y - picture.area.y)};
    }
    const bool shaded_row = y >= shaded.y && y < shaded.br().y;
    const std::size_t row_start = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    runs.beginRow();
    for (int x = all.x; x < all.br().x; ++x) {
      const Pixel& pixel = pixels_[row_start + static_cast<std::size_t>(x)];
      const cv::Vec4b* light = nullptr;
      for (std::size_t k = 0; k < count; ++k) {
        if (x >= pieces[k].first && x < pieces[k].last)
          light = &pieces[k].light[x - pieces[k].first];
      }
      float kept = 1;
      if (shaded_row && x >= shaded.x && x < shaded.br().x && pixel.floor_x != kNoFloor)
        kept = share(pixel);
      const bool covered = light != nullptr && (*light)[3] > 0;
      if (!covered && kept >= FloorShade::kFaintest) continue;
      float signal = signalOf(pixel, variant) * kept;
      if (covered) {
        const std::size_t c = colourAt(x, y);
        const auto lens = static_cast<float>(camera_.falloff(x, y) * camera_.response[c]);
        const float cover = static_cast<float>((*light)[3]) / 255;
        const float root = static_cast<float>((*light)[static_cast<int>(c)]) / 255;
        signal = signal * (1 - cover) + root * root / cover * lens * kFullScale_dn;
      }
      const auto at = static_cast<std::uint32_t>(row_start) + static_cast<std::uint32_t>(x);
      // The pixels of a gap are the empty hall's, with noise of this moment.
      for (std::uint32_t gap = runs.add(at); gap > 0; --gap)
        patch.pixels.push_back(digitise(signalOf(pixels_[at - gap], variant), noise.next()));
      patch.pixels.push_back(digitise(signal, noise.next()));
    }
  }
  return patch;
}

}  // namespace emulator::studio
