#include "hal/emulated/openni/practice_room.h"

#include <algorithm>
#include <cmath>

namespace emulator {
namespace {

constexpr double kEye_m = 1.2;  // over the floor
constexpr double kBackWall_m = 5.5;
constexpr double kSideWall_m = 2.8;
constexpr double kCeiling_m = 1.8;  // over the eye

struct Point {
  double x, y, z;
};
Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Point between(const Point& a, const Point& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

struct Colour {
  double r, g, b;
};
constexpr Colour kSkin{205, 160, 130};
constexpr Colour kShirt{40, 90, 170};
constexpr Colour kTrousers{60, 60, 66};
constexpr Colour kHair{35, 25, 20};

void paint(std::uint8_t* rgb, const Colour& colour, double light) {
  const auto byte = [light](double value) {
    return static_cast<std::uint8_t>(std::clamp(value * light, 0.0, 255.0));
  };
  rgb[0] = byte(colour.r);
  rgb[1] = byte(colour.g);
  rgb[2] = byte(colour.b);
}

class Painter {
 public:
  Painter(const RgbdFormat& format, const DepthRingWriter::Canvas& canvas)
      : format_(format), canvas_(canvas) {}

  void ball(const Point& at, double radius_m, const Colour& colour) {
    const double u = format_.centre_x_px + format_.focal_px * at.x / at.z;
    const double v = format_.centre_y_px + format_.focal_px * at.y / at.z;
    const double radius_px = format_.focal_px * radius_m / at.z;
    const auto last = [](std::uint32_t size) { return static_cast<double>(size) - 1; };
    const auto top = static_cast<std::size_t>(std::max(0.0, std::ceil(v - radius_px)));
    const auto left = static_cast<std::size_t>(std::max(0.0, std::ceil(u - radius_px)));
    const double bottom = std::min(last(format_.height_px), v + radius_px);
    const double right = std::min(last(format_.width_px), u + radius_px);
    for (std::size_t y = top; static_cast<double>(y) <= bottom; ++y) {
      for (std::size_t x = left; static_cast<double>(x) <= right; ++x) {
        const double dx = (static_cast<double>(x) - u) / radius_px;
        const double dy = (static_cast<double>(y) - v) / radius_px;
        const double rest = 1 - dx * dx - dy * dy;
        if (rest <= 0) continue;
        const auto depth_m = static_cast<float>(at.z - radius_m * std::sqrt(rest));
        const std::size_t pixel = y * format_.width_px + x;
        if (depth_m >= canvas_.depth_m[pixel]) continue;
        canvas_.depth_m[pixel] = depth_m;
        if (!canvas_.colour_rgb.empty())
          paint(&canvas_.colour_rgb[3 * pixel], colour, 0.45 + 0.4 * std::sqrt(rest) - 0.2 * dy);
      }
    }
  }

  void limb(const Point& from, const Point& to, double radius_m, const Colour& colour) {
    const double length = std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
    const int steps = 1 + static_cast<int>(length / (0.35 * radius_m));
    for (int i = 0; i <= steps; ++i) ball(between(from, to, 1.0 * i / steps), radius_m, colour);
  }

 private:
  const RgbdFormat& format_;
  const DepthRingWriter::Canvas& canvas_;
};

/// Where the person stands: on the floor, under the chest.
Point feet(double time_s) {
  return {0.9 * std::sin(0.5 * time_s), kEye_m, 3.0 + 0.5 * std::sin(0.33 * time_s)};
}

void person(Painter& painter, double time_s) {
  const Point at = feet(time_s);
  const double walk = std::sin(4 * time_s);
  const double wave = 1.2 + 1.1 * std::sin(2 * time_s);
  painter.limb(at + Point{0, -0.95, 0}, at + Point{0, -1.4, 0}, 0.15, kShirt);
  painter.ball(at + Point{0, -1.66, 0}, 0.11, kSkin);
  painter.ball(at + Point{0, -1.70, 0.02}, 0.11, kHair);
  for (const double side : {-1.0, 1.0}) {
    const Point hip = at + Point{0.1 * side, -0.92, 0};
    const Point knee = at + Point{0.11 * side, -0.5, -0.2 * side * walk};
    const Point ankle = at + Point{0.12 * side, -0.08, -0.3 * side * walk + 0.05};
    painter.limb(hip, knee, 0.08, kTrousers);
    painter.limb(knee, ankle, 0.055, kTrousers);
    painter.limb(ankle, ankle + Point{0, 0.03, -0.12}, 0.045, kHair);
    const Point shoulder = at + Point{0.19 * side, -1.42, 0};
    const double lift = side > 0 ? wave : 0.1;
    const Point elbow =
        shoulder + Point{0.28 * side * std::sin(lift), 0.28 * std::cos(lift), -0.05};
    painter.limb(shoulder, elbow, 0.05, kShirt);
    painter.limb(
        elbow,
        elbow + Point{0.26 * side * std::sin(1.3 * lift), 0.26 * std::cos(1.3 * lift), -0.08},
        0.042, kSkin);
  }
}

}  // namespace

std::array<double, 3> PracticeRoom::chest(double time_s) {
  const Point at = feet(time_s);
  return {at.x, at.y - 1.4, at.z};
}

PracticeRoom::PracticeRoom(const RgbdFormat& format)
    : format_(format), depth_m_(format.pixels()), rgb_(3 * format.pixels()) {
  for (std::size_t i = 0; i < format.pixels(); ++i) {
    const std::size_t column = i % format.width_px;
    const std::size_t row = i / format.width_px;
    const double x = (static_cast<double>(column) - format.centre_x_px) / format.focal_px;
    const double y = (static_cast<double>(row) - format.centre_y_px) / format.focal_px;
    // Where the pixel's ray meets the nearest of the planes around us.
    const double floor_m = y > 1e-6 ? kEye_m / y : 1e9;
    const double ceiling_m = y < -1e-6 ? -kCeiling_m / y : 1e9;
    const double side_m = std::abs(x) > 1e-6 ? kSideWall_m / std::abs(x) : 1e9;
    const double z = std::min({kBackWall_m, floor_m, ceiling_m, side_m});
    depth_m_[i] = static_cast<float>(z);
    const auto cell = [](double metres) { return static_cast<int>(std::floor(metres * 2)); };
    Colour colour{190, 185, 170};
    if (z == floor_m)
      colour = (cell(x * z) + cell(z)) % 2 == 0 ? Colour{150, 110, 70} : Colour{130, 95, 60};
    if (z == ceiling_m) colour = {220, 220, 220};
    if (z == side_m) colour = cell(y * z) % 2 == 0 ? Colour{150, 165, 150} : Colour{140, 150, 140};
    paint(&rgb_[3 * i], colour, 1.1 - 0.08 * z);
  }
}

void PracticeRoom::draw(double time_s, bool lamp, const DepthRingWriter::Canvas& canvas) const {
  std::ranges::copy(depth_m_, canvas.depth_m.begin());
  if (!canvas.colour_rgb.empty()) {
    std::ranges::copy(rgb_, canvas.colour_rgb.begin());
    const std::size_t side = format_.width_px / 20;
    for (std::size_t y = 0; y < side && lamp; ++y) {
      std::fill_n(canvas.colour_rgb.begin() + static_cast<std::ptrdiff_t>(3 * y * format_.width_px),
                  3 * side, std::uint8_t{250});
    }
  }
  Painter painter(format_, canvas);
  person(painter, time_s);
}

}  // namespace emulator
