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

struct LinearView {
  cv::Mat3f light;   // with gains, weighed by cover
  cv::Mat1f cover;   // 0 to 1: the part of the lookup that lies in the source
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
  const auto& [red, green, blue] = plan.gain_rgb;
  cv::Mat3f linear;
  linear_rgb.convertTo(linear, CV_32FC3, 1.0 / 255);
  for (cv::Vec3f& pixel : linear) pixel = pixel.mul(cv::Vec3f(red, green, blue));
  const cv::Mat1f full(linear_rgb.size(), 1.0F);
  cv::remap(linear, view.light, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  cv::remap(full, view.cover, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return view;
}

}  // namespace

ReferencePicture referenceWarp(const hal::WarpPlan& plan, const cv::Mat3b& linear_rgb,
                               cv::Size display) {
  const LinearView view = warpLinear(plan, linear_rgb, display);
  ReferencePicture picture{.rgb = cv::Mat3f(display), .inside = view.inside, .border = view.border};
  std::transform(view.light.begin(), view.light.end(), picture.rgb.begin(), encoded);
  return picture;
}

cv::Mat3f referenceScene(std::span<const ReferenceLayer> layers, cv::Size display) {
  cv::Mat3f sum(display, cv::Vec3f(0, 0, 0));
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
