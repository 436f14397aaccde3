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

}  // namespace

ReferencePicture referenceWarp(const hal::WarpPlan& plan, const cv::Mat3b& linear_rgb,
                               cv::Size display) {
  constexpr float kNowhere = -10;
  cv::Mat1f map_x(display, kNowhere);
  cv::Mat1f map_y(display, kNowhere);
  ReferencePicture picture{.rgb = cv::Mat3f(display),
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
        picture.border(y, x) = 255;
        continue;
      }
      map_x(y, x) = static_cast<float>(at.u_px);
      map_y(y, x) = static_cast<float>(at.v_px);
      const bool inside =
          at.u_px >= 0 && at.v_px >= 0 && at.u_px <= width_px - 1 && at.v_px <= height_px - 1;
      if (inside) picture.inside(y, x) = 255;
    }
  }
  cv::Mat3f linear;
  linear_rgb.convertTo(linear, CV_32FC3, 1.0 / 255);
  cv::Mat3f warped;
  cv::remap(linear, warped, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  const auto& gain = plan.gain_rgb;
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        picture.rgb(y, x)[c] = static_cast<float>(
            255 * encodeSrgb(double{warped(y, x)[c]} * double{gain[static_cast<std::size_t>(c)]}));
      }
    }
  }
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
