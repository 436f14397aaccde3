#include "tests/golden/reference_warp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace {

struct Lookup {
  bool valid = false;
  double u_px = 0, v_px = 0;
};

Lookup lookUp(const hal::WarpPlan& plan, double x_px, double y_px) {
  const auto& h = plan.H_camera_display;
  const auto& lens = plan.lens;
  const double w = h[6] * x_px + h[7] * y_px + h[8];
  if (!(w > 0)) return {};
  const double x = ((h[0] * x_px + h[1] * y_px + h[2]) / w - lens.cx_px) / lens.fx_px;
  const double y = ((h[3] * x_px + h[4] * y_px + h[5]) / w - lens.cy_px) / lens.fy_px;
  if (!(std::hypot(x, y) <= lens.max_radius)) return {};
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  const double r2 = x * x + y * y;
  const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return {true, lens.fx_px * xd + lens.cx_px, lens.fy_px * yd + lens.cy_px};
}

/// Dark grey, the sRGB code 18, in linear light.
const double kSurround = std::pow((18.0 / 255 + 0.055) / 1.055, 2.4);

double encodeSrgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

cv::Vec3f encoded(const cv::Vec3f& linear) {
  cv::Vec3f code;
  for (int c = 0; c < 3; ++c) {
    code[c] = static_cast<float>(255 * encodeSrgb(double{linear[c]}));
  }
  return code;
}

/// From the stored value at a pixel of the source to linear light, in the order of
/// hal::ColourModel.
cv::Vec3f developed(const hal::WarpPlan& plan, const cv::Vec3f& stored, double u_px, double v_px) {
  const hal::ColourModel& colour = plan.colour;
  const double half_diagonal = std::hypot(plan.source.width_px, plan.source.height_px) / 2;
  const double r = std::hypot(u_px - plan.lens.cx_px, v_px - plan.lens.cy_px) / half_diagonal;
  const double fall_off = 1 + colour.vignetting[0] * std::pow(r, 2) +
                          colour.vignetting[1] * std::pow(r, 4) +
                          colour.vignetting[2] * std::pow(r, 6);
  cv::Vec3d balanced;
  for (int c = 0; c < 3; ++c) {
    const double code = 255 * double{stored[c]};
    const double light = (code - double{colour.black_level}) / (255 - double{colour.black_level});
    balanced[c] = light / fall_off * double{colour.gain_rgb[static_cast<std::size_t>(c)]};
  }
  cv::Vec3f rgb;
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
      sum += double{colour.matrix[3 * row + c]} * balanced[static_cast<int>(c)];
    rgb[static_cast<int>(row)] = static_cast<float>(std::max(0.0, sum));
  }
  return rgb;
}

float shownAt(const hal::EdgeMask& edge, double u, double v) {
  const double in = std::clamp((1 - edge.at(u, v)) / double{hal::EdgeMask::kFeather}, 0.0, 1.0);
  return static_cast<float>(in * in * (3 - 2 * in));
}

struct LinearView {
  cv::Mat3f light;   // weighed by cover
  cv::Mat1f cover;   // 0 to 1: the part of the lookup in the source, times the soft edge
  cv::Mat1b inside;  // as in ReferencePicture
  cv::Mat1b border;
};

LinearView warpLinear(const hal::WarpPlan& plan, const cv::Mat3b& linear_rgb, cv::Size display) {
  constexpr float kNowhere = -10;
  cv::Mat1f map_x(display, kNowhere);
  cv::Mat1f map_y(display, kNowhere);
  LinearView view{.light = {},
                  .cover = {},
                  .inside = cv::Mat1b(display, uchar{0}),
                  .border = cv::Mat1b(display, uchar{0})};
  const double width_px = plan.source.width_px;
  const double height_px = plan.source.height_px;
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      const Lookup at = lookUp(plan, x, y);
      const bool off = !at.valid || at.u_px <= -1 || at.v_px <= -1 || at.u_px >= width_px ||
                       at.v_px >= height_px;
      if (off) {
        view.border(y, x) = 255;
        continue;
      }
      map_x(y, x) = static_cast<float>(at.u_px);
      map_y(y, x) = static_cast<float>(at.v_px);
      const bool inside =
          at.u_px >= 0 && at.v_px >= 0 && at.u_px <= width_px - 1 && at.v_px <= height_px - 1;
      if (inside) view.inside(y, x) = 255;
    }
  }
  cv::Mat3f stored;
  linear_rgb.convertTo(stored, CV_32FC3, 1.0 / 255);
  const cv::Mat1f full(linear_rgb.size(), 1.0F);
  cv::remap(stored, view.light, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(full, view.cover, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      view.cover(y, x) *=
          shownAt(plan.edge, (2 * x + 1.0) / display.width - 1, (2 * y + 1.0) / display.height - 1);
      view.light(y, x) =
          developed(plan, view.light(y, x), map_x(y, x), map_y(y, x)) * view.cover(y, x);
    }
  }
  return view;
}

}  // namespace

ReferencePicture referenceWarp(const hal::WarpPlan& plan, const cv::Mat3b& linear_rgb,
                               cv::Size display) {
  const LinearView view = warpLinear(plan, linear_rgb, display);
  ReferencePicture picture{.rgb = cv::Mat3f(display), .inside = view.inside, .border = view.border};
  const cv::Vec3f surround = cv::Vec3f::all(static_cast<float>(kSurround));
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      const float cover = view.cover(y, x);
      cv::Vec3f light = view.light(y, x);
      for (int c = 0; c < 3; ++c) light[c] = std::min(light[c], cover);
      picture.rgb(y, x) = encoded(light + (1 - cover) * surround);
    }
  }
  return picture;
}

cv::Mat3f referenceScene(std::span<const ReferenceLayer> layers, cv::Size display) {
  const auto surround = static_cast<float>(kSurround);
  cv::Mat3f sum(display, cv::Vec3f(surround, surround, surround));
  for (const auto& [layer, linear_rgb] : layers) {
    const LinearView view = warpLinear(layer.plan, linear_rgb, display);
    const hal::RectPx where = common(layer.where, {0, 0, display.width, display.height});
    for (int y = where.y; y < where.y + where.height; ++y) {
      for (int x = where.x; x < where.x + where.width; ++x) {
        const float hides = view.cover(y, x) * layer.opacity;
        for (int c = 0; c < 3; ++c) {
          const float light = std::min(view.light(y, x)[c], view.cover(y, x)) * layer.opacity;
          sum(y, x)[c] = sum(y, x)[c] * (1 - hides) + light;
        }
      }
    }
  }
  cv::Mat3f picture(display);
  std::transform(sum.begin(), sum.end(), picture.begin(), encoded);
  return picture;
}

double psnr(const cv::Mat3f& a, const cv::Mat3f& b, const cv::Mat1b& mask) {
  cv::Mat3f difference;
  cv::subtract(a, b, difference);
  const cv::Scalar mean_square = cv::mean(difference.mul(difference), mask);
  const double error = (mean_square[0] + mean_square[1] + mean_square[2]) / 3;
  return error == 0 ? std::numeric_limits<double>::infinity()
                    : 10 * std::log10(255.0 * 255.0 / error);
}
