#include "hal/emulated/studio/floor_cover.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/hall_size.h"
#include "hal/emulated/studio/noise.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

constexpr float kPxPerMetre = 170;
constexpr float kStrip_m = 0.075f;

int px(float metres) {
  return static_cast<int>(std::lround(metres * kPxPerMetre));
}
cv::Point at(float x, float y) {
  return {px(x - kHallLeft_m), px(kHallBack_m - y)};
}

/// Strips lie along x, each of boards of its own length and tone.
cv::Mat drawStrips(cv::Size size, std::uint64_t seed) {
  const cv::Mat broad = fractalNoise({size.width / 8, size.height / 8}, 90, 5, seed);
  cv::Mat wide;
  cv::resize(broad, wide, size, 0, 0, cv::INTER_LINEAR);
  Random random(seed + 1);
  cv::Mat floor(size, CV_8UC3);
  const int strip_px = px(kStrip_m);
  const int strips = size.height / strip_px + 1;
  std::vector<std::uint8_t> gap(static_cast<std::size_t>(size.width));
  std::vector<cv::Vec3f> tone(static_cast<std::size_t>(size.width));
  for (int strip = 0; strip < strips; ++strip) {
    std::fill(gap.begin(), gap.end(), 0);
    int x = -static_cast<int>(random.next() % 90);
    while (x < size.width) {
      const int length = px(random.uniform(0.35f, 1.1f));
      const float light = random.uniform(0.84f, 1.06f) * (random.unit() < 0.06 ? 0.84f : 1.0f);
      const float red = random.uniform(-0.03f, 0.035f);
      const cv::Vec3f board((0.800f + red) * light, 0.640f * light, (0.435f - red) * light);
      for (int i = std::max(0, x); i < std::min(size.width, x + length); ++i)
        tone[static_cast<std::size_t>(i)] = board;
      if (x >= 0) gap[static_cast<std::size_t>(x)] = 1;
      x += length;
    }
    for (int y = strip * strip_px; y < std::min(size.height, (strip + 1) * strip_px); ++y) {
      const bool joint = y == strip * strip_px;
      auto* row = floor.ptr<cv::Vec3b>(y);
      const auto* shade = wide.ptr<float>(y);
      for (int column = 0; column < size.width; ++column) {
        const auto i = static_cast<std::size_t>(column);
        const float v = (joint         ? 0.80f
                         : gap[i] != 0 ? 0.72f
                                       : 1.0f) *
                        (0.93f + 0.16f * (shade[column] - 0.5f));
        for (int c = 0; c < 3; ++c)
          row[column][c] = cv::saturate_cast<std::uint8_t>(255 * v * tone[i][c]);
      }
    }
  }
  return floor;
}

/// Paint over the boards, worn so that some of the wood shows.
void paintLines(cv::Mat& floor, std::uint64_t seed) {
  cv::Mat paint(floor.size(), CV_8UC3, cv::Scalar::all(0));
  cv::Mat mask(floor.size(), CV_8U, cv::Scalar::all(0));
  const auto line = [&](float x0, float y0, float x1, float y1, float width,
                        const cv::Scalar& rgb) {
    cv::line(paint, at(x0, y0), at(x1, y1), rgb, px(width) + 3);
    cv::line(mask, at(x0, y0), at(x1, y1), cv::Scalar(255), px(width), cv::LINE_AA);
  };
  const auto arc = [&](float x, float y, float radius, double from, double to, float width,
                       const cv::Scalar& rgb) {
    cv::ellipse(paint, at(x, y), {px(radius), px(radius)}, 0, -to, -from, rgb, px(width) + 3);
    cv::ellipse(mask, at(x, y), {px(radius), px(radius)}, 0, -to, -from, cv::Scalar(255), px(width),
                cv::LINE_AA);
  };
  const auto frame = [&](float x0, float y0, float x1, float y1, float width,
                         const cv::Scalar& rgb) {
    line(x0, y0, x1, y0, width, rgb);
    line(x1, y0, x1, y1, width, rgb);
    line(x1, y1, x0, y1, width, rgb);
    line(x0, y1, x0, y0, width, rgb);
  };
  const cv::Scalar kWhite(240, 238, 230);
  const cv::Scalar kBlack(38, 36, 36);
  const cv::Scalar kYellow(236, 196, 40);
  const cv::Scalar kBlue(36, 78, 160);
  const cv::Scalar kGreen(30, 120, 72);
  const cv::Scalar kRed(190, 44, 40);
  // Badminton, white; volleyball, green; basketball, black with a filled key; handball, yellow.
  frame(-8.9f, -3.05f, 4.5f, 3.05f, 0.04f, kWhite);
  line(-8.9f, 0, -4.2f, 0, 0.04f, kWhite);
  line(-0.2f, 0, 4.5f, 0, 0.04f, kWhite);
  line(-4.2f, -3.05f, -4.2f, 3.05f, 0.04f, kWhite);
  line(-0.2f, -3.05f, -0.2f, 3.05f, 0.04f, kWhite);
  frame(-9.4f, -4.5f, 8.6f, 4.5f, 0.05f, kGreen);
  line(2.6f, -4.5f, 2.6f, 4.5f, 0.05f, kGreen);
  line(-3.4f, -4.5f, -3.4f, 4.5f, 0.05f, kGreen);
  frame(-9.9f, -8.0f, 9.9f, 6.9f, 0.05f, kBlack);
  // The key below the basket.
  const std::vector<cv::Point> key = {at(-2.1f, 6.9f), at(2.8f, 6.9f), at(2.8f, 1.1f),
                                      at(-2.1f, 1.1f)};
  cv::Mat filled(floor.size(), CV_8U, cv::Scalar::all(0));
  cv::fillConvexPoly(filled, key, cv::Scalar(255));
  paint.setTo(cv::Scalar(150, 52, 38), filled);
  cv::Mat key_mask = filled * 0.80;
  cv::max(mask, key_mask, mask);
  frame(-2.1f, 1.1f, 2.8f, 6.9f, 0.05f, kWhite);
  arc(0.35f, 1.1f, 1.8f, 0, 360, 0.05f, kBlack);
  arc(0.35f, 5.3f, 6.25f, 180, 360, 0.05f, kBlack);
  arc(3.1f, 5.8f, 6.0f, 150, 390, 0.05f, kYellow);
  for (int i = 0; i < 20; ++i) {
    const double from = 160 + i * 10.5;
    arc(3.1f, 5.8f, 9.0f, from, from + 3, 0.05f, kYellow);
  }
  line(2.6f, -1.2f, 3.6f, -1.2f, 0.05f, kYellow);
  line(-10.4f, 5.8f, 10.4f, 5.8f, 0.05f, kBlue);
  arc(-6.0f, -1.5f, 1.8f, 0, 360, 0.05f, kRed);
  line(-6.0f, -8.2f, -6.0f, 7.2f, 0.05f, kRed);
  // Where the athlete stands: a cross of tape and a throwing line.
  line(-0.22f, 0.5f, 0.22f, 0.5f, 0.035f, kWhite);
  line(0, 0.28f, 0, 0.72f, 0.035f, kWhite);
  line(-1.3f, -1.0f, 1.1f, -1.0f, 0.05f, kBlue);

  cv::Mat wear = fractalNoise({floor.cols / 2, floor.rows / 2}, 40, 6, seed);
  cv::resize(wear, wear, floor.size());
  for (int y = 0; y < floor.rows; ++y) {
    for (int x = 0; x < floor.cols; ++x) {
      const std::uint8_t coverage = mask.at<std::uint8_t>(y, x);
      if (coverage == 0) continue;
      const float worn = std::clamp(1.35f - 0.75f * wear.at<float>(y, x), 0.4f, 0.97f);
      const float alpha = static_cast<float>(coverage) / 255 * worn;
      auto& pixel = floor.at<cv::Vec3b>(y, x);
      const auto& colour = paint.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[c]) * (1 - alpha) +
                                                   static_cast<float>(colour[c]) * alpha);
    }
  }
}

/// Rubber marks of soles, dirt, and a few strips of coloured tape.
void wearOut(cv::Mat& floor, std::uint64_t seed) {
  Random random(seed);
  cv::Mat marks(floor.size(), CV_8U, cv::Scalar::all(0));
  for (int i = 0; i < 900; ++i) {
    const cv::Point from(static_cast<int>(random.next() % static_cast<std::uint64_t>(floor.cols)),
                         static_cast<int>(random.next() % static_cast<std::uint64_t>(floor.rows)));
    const float angle = random.uniform(0, 6.28f);
    const float length = random.uniform(0.03f, 0.22f) * kPxPerMetre;
    const cv::Point to = from + cv::Point(static_cast<int>(length * std::cos(angle)),
                                          static_cast<int>(length * std::sin(angle)));
    cv::line(marks, from, to, cv::Scalar(random.uniform(20, 110)),
             1 + static_cast<int>(random.next() % 3), cv::LINE_AA);
  }
  for (int i = 0; i < 700; ++i) {
    const cv::Point spot(static_cast<int>(random.next() % static_cast<std::uint64_t>(floor.cols)),
                         static_cast<int>(random.next() % static_cast<std::uint64_t>(floor.rows)));
    cv::circle(marks, spot, 1 + static_cast<int>(random.next() % 3),
               cv::Scalar(random.uniform(30, 140)), cv::FILLED, cv::LINE_AA);
  }
  cv::GaussianBlur(marks, marks, {3, 3}, 0.8);
  for (int y = 0; y < floor.rows; ++y) {
    for (int x = 0; x < floor.cols; ++x) {
      const float dark = 1 - 0.7f * static_cast<float>(marks.at<std::uint8_t>(y, x)) / 255;
      if (dark >= 1) continue;
      auto& pixel = floor.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[c]) * dark);
    }
  }
  const cv::Scalar tapes[] = {{220, 60, 150}, {60, 160, 210}, {240, 240, 240}, {250, 130, 30}};
  for (int i = 0; i < 34; ++i) {
    const float x = random.uniform(-6, 6);
    const float y = random.uniform(-3, 6);
    const bool along = random.unit() < 0.5;
    const float length = random.uniform(0.12f, 0.34f);
    cv::line(floor, at(x, y), at(x + (along ? length : 0), y + (along ? 0 : length)),
             tapes[random.next() % 4], px(0.025f), cv::LINE_AA);
  }
}

}  // namespace

cv::Mat drawFloor(std::uint64_t seed) {
  const cv::Size size(px(kHallRight_m - kHallLeft_m), px(kHallBack_m - kHallFront_m));
  cv::Mat floor = drawStrips(size, seed);
  paintLines(floor, seed + 5);
  wearOut(floor, seed + 6);
  return floor;
}

}  // namespace emulator::studio
