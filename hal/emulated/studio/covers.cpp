#include "hal/emulated/studio/covers.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/floor_cover.h"
#include "hal/emulated/studio/noise.h"
#include "hal/emulated/studio/posters.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

/// An RGB picture of one grey, times value(x, y).
cv::Mat grey(cv::Size size, const std::function<float(int, int)>& value) {
  cv::Mat picture(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto v = cv::saturate_cast<std::uint8_t>(255 * value(x, y));
      picture.at<cv::Vec3b>(y, x) = {v, v, v};
    }
  }
  return picture;
}

/// 4 m by 4 m of painted brick: courses of 7.7 cm, bricks of 25 cm, chips, stains, old screws.
cv::Mat drawBrick(std::uint64_t seed) {
  constexpr int kSide = 1024;
  constexpr int kCourses = 52;
  constexpr int kBricks = 16;
  const cv::Mat stain = fractalNoise({kSide, kSide}, 256, 6, seed);
  const cv::Mat grain = fractalNoise({kSide, kSide}, 8, 3, seed + 1);
  Random random(seed);
  std::vector<float> tone(kCourses * kBricks);
  for (float& t : tone) t = random.uniform(-0.09f, 0.07f);
  cv::Mat picture = grey({kSide, kSide}, [&](int x, int y) {
    const float course = static_cast<float>(y) * kCourses / kSide;
    const int row = static_cast<int>(course);
    float along = static_cast<float>(x) * kBricks / kSide + (row % 2 == 0 ? 0.0f : 0.5f);
    along = std::fmod(along, static_cast<float>(kBricks));
    const int brick = static_cast<int>(along);
    const float edge_y =
        std::min(course - static_cast<float>(row), static_cast<float>(row + 1) - course) *
        (kSide / static_cast<float>(kCourses));
    const float edge_x =
        std::min(along - static_cast<float>(brick), static_cast<float>(brick + 1) - along) *
        (kSide / static_cast<float>(kBricks));
    const float edge = std::min(edge_x, edge_y) - 1.6f * (grain.at<float>(y, x) - 0.3f);
    const float joint = std::clamp((edge - 0.6f) / 1.6f, 0.0f, 1.0f);
    const float lit_edge = edge_y < 3.0f && course - static_cast<float>(row) > 0.5f ? 0.05f : 0.0f;
    const float body =
        0.84f + tone[static_cast<std::size_t>(row) * kBricks + static_cast<std::size_t>(brick)] +
        0.16f * (stain.at<float>(y, x) - 0.5f) + 0.20f * (grain.at<float>(y, x) - 0.5f) + lit_edge;
    return body * joint + (0.58f + 0.2f * (stain.at<float>(y, x) - 0.5f)) * (1 - joint);
  });
  for (int i = 0; i < 70; ++i) {  // chipped paint shows the clay
    const cv::Point at(static_cast<int>(random.next() % kSide),
                       static_cast<int>(random.next() % kSide));
    const cv::Size size(1 + static_cast<int>(random.next() % 4),
                        1 + static_cast<int>(random.next() % 3));
    cv::ellipse(picture, at, size, random.uniform(0, 180), 0, 360, cv::Scalar(150, 96, 74),
                cv::FILLED, cv::LINE_AA);
  }
  for (int i = 0; i < 26; ++i) {
    const cv::Point at(static_cast<int>(random.next() % kSide),
                       static_cast<int>(random.next() % kSide));
    cv::circle(picture, at, 2, cv::Scalar(60, 58, 55), cv::FILLED, cv::LINE_AA);
  }
  return picture;
}

/// 3 m by 3 m of standing planks 12 cm wide with knots.
cv::Mat drawPlanks(std::uint64_t seed) {
  constexpr int kSide = 768;
  constexpr int kPlanks = 25;
  const cv::Mat noise = fractalNoise({kSide, kSide}, 128, 6, seed);
  cv::Mat streaks = fractalNoise({kSide, 64}, 6, 3, seed + 1);
  cv::resize(streaks, streaks, {kSide, kSide}, 0, 0, cv::INTER_CUBIC);
  Random random(seed + 2);
  std::array<float, kPlanks> tone{};
  std::array<int, kPlanks> shift{};
  for (std::size_t i = 0; i < kPlanks; ++i) {
    tone[i] = random.uniform(-0.13f, 0.11f);
    shift[i] = static_cast<int>(random.next() % kSide);
  }
  cv::Mat picture(kSide, kSide, CV_8UC3);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float across = static_cast<float>(x) * kPlanks / kSide;
      const auto plank = static_cast<std::size_t>(across);
      const float edge =
          std::min(across - static_cast<float>(plank), static_cast<float>(plank + 1) - across) *
          kSide / kPlanks;
      const int moved = (y + shift[plank]) % kSide;
      const float grain = streaks.at<float>(moved, x) - 0.5f;
      float v = 0.78f + tone[plank] + 0.34f * grain + 0.16f * (noise.at<float>(moved, x) - 0.5f);
      v *= std::clamp(0.35f + edge * 0.5f, 0.35f, 1.0f);
      auto& pixel = picture.at<cv::Vec3b>(y, x);
      pixel[0] = cv::saturate_cast<std::uint8_t>(255 * v);
      pixel[1] = cv::saturate_cast<std::uint8_t>(255 * (v - 0.10f * (1 - v) - 0.05f * grain));
      pixel[2] = cv::saturate_cast<std::uint8_t>(255 * (v - 0.30f * (1 - v) - 0.10f * grain));
    }
  }
  for (int i = 0; i < 90; ++i) {
    const cv::Point at(static_cast<int>(random.next() % kSide),
                       static_cast<int>(random.next() % kSide));
    const int r = 2 + static_cast<int>(random.next() % 3);
    cv::ellipse(picture, at, {r, r + 2}, 0, 0, 360, cv::Scalar(122, 78, 44), cv::FILLED,
                cv::LINE_AA);
    cv::ellipse(picture, at, {r + 2, r + 5}, 0, 0, 360, cv::Scalar(160, 116, 74), 1, cv::LINE_AA);
  }
  return picture;
}

cv::Mat drawPlaster(std::uint64_t seed) {
  constexpr int kSide = 1024;
  const cv::Mat stain = fractalNoise({kSide, kSide}, 340, 5, seed);
  const cv::Mat grain = fractalNoise({kSide, kSide}, 10, 4, seed + 1);
  cv::Mat picture = grey({kSide, kSide}, [&](int x, int y) {
    return 0.90f + 0.07f * (stain.at<float>(y, x) - 0.5f) + 0.045f * (grain.at<float>(y, x) - 0.5f);
  });
  Random random(seed);
  for (int i = 0; i < 80; ++i) {  // marks that balls have left
    const cv::Point at(static_cast<int>(random.next() % kSide),
                       static_cast<int>(random.next() % kSide));
    const int r = 4 + static_cast<int>(random.next() % 18);
    cv::Mat patch = picture.clone();
    // A ball presses its middle on and only grazes round it.
    const double dark = random.uniform(120, 190);
    cv::circle(patch, at, r, cv::Scalar::all(0.5 * dark + 110), cv::FILLED, cv::LINE_AA);
    cv::circle(patch, at, r * 2 / 3, cv::Scalar::all(dark), cv::FILLED, cv::LINE_AA);
    const double weight = random.uniform(0.05f, 0.22f);
    const cv::Rect area =
        cv::Rect(at.x - r - 1, at.y - r - 1, 2 * r + 3, 2 * r + 3) & cv::Rect(0, 0, kSide, kSide);
    cv::Mat target = picture(area);
    cv::addWeighted(patch(area), weight, target, 1 - weight, 0, target);
  }
  return picture;
}

/// Perforated acoustic panels of 60 cm by 120 cm.
cv::Mat drawCeiling(std::uint64_t seed) {
  constexpr int kSide = 512;
  const cv::Mat noise = fractalNoise({kSide, kSide}, 128, 5, seed);
  return grey({kSide, kSide}, [&](int x, int y) {
    const int px = x % 128;
    const int py = y % 256;
    const bool joint = px < 3 || py < 3;
    const bool hole =
        (px - 10) % 9 < 3 && (py - 10) % 9 < 3 && px > 10 && py > 10 && px < 120 && py < 248;
    return (joint ? 0.42f : hole ? 0.58f : 0.84f) + 0.14f * (noise.at<float>(y, x) - 0.5f);
  });
}

cv::Mat drawWood(std::uint64_t seed) {
  constexpr int kSide = 512;
  cv::Mat streaks = fractalNoise({64, kSide}, 5, 3, seed);
  cv::resize(streaks, streaks, {kSide, kSide}, 0, 0, cv::INTER_CUBIC);
  const cv::Mat noise = fractalNoise({kSide, kSide}, 100, 6, seed + 1);
  return grey({kSide, kSide}, [&](int x, int y) {
    const float ring =
        0.5f + 0.5f * std::sin(static_cast<float>(y) * 0.10f + 9 * noise.at<float>(y, x));
    return 0.78f + 0.24f * (streaks.at<float>(y, x) - 0.5f) + 0.06f * (ring - 0.5f) +
           0.09f * (noise.at<float>(y, x) - 0.5f);
  });
}

cv::Mat drawVinyl(std::uint64_t seed) {
  constexpr int kSide = 256;
  const cv::Mat wear = fractalNoise({kSide, kSide}, 80, 6, seed);
  const cv::Mat grain = fractalNoise({kSide, kSide}, 5, 2, seed + 1);
  return grey({kSide, kSide}, [&](int x, int y) {
    const bool seam = x < 3;
    return (seam ? 0.70f : 0.86f) + 0.14f * (wear.at<float>(y, x) - 0.5f) +
           0.06f * (grain.at<float>(y, x) - 0.5f);
  });
}

cv::Mat drawMetal(std::uint64_t seed) {
  constexpr int kSide = 256;
  const cv::Mat wear = fractalNoise({kSide, kSide}, 60, 6, seed);
  cv::Mat picture = grey(
      {kSide, kSide}, [&](int x, int y) { return 0.90f + 0.3f * (wear.at<float>(y, x) - 0.5f); });
  Random random(seed);
  for (int i = 0; i < 60; ++i) {
    const cv::Point at(static_cast<int>(random.next() % kSide),
                       static_cast<int>(random.next() % kSide));
    const cv::Point to = at + cv::Point(static_cast<int>(random.uniform(-20, 20)),
                                        static_cast<int>(random.uniform(-20, 20)));
    cv::line(picture, at, to, cv::Scalar::all(random.uniform(120, 235)), 1, cv::LINE_AA);
  }
  return picture;
}

/// Cords every 10 cm; the tile is 50 cm.
cv::Mat drawNet() {
  constexpr int kSide = 128;
  cv::Mat net(kSide, kSide, CV_8UC4, cv::Scalar(235, 235, 230, 0));
  for (int i = 0; i <= 5; ++i) {
    const int at = i * kSide / 5;
    cv::line(net, {at, 0}, {at, kSide}, cv::Scalar(235, 235, 230, 255), 2);
    cv::line(net, {0, at}, {kSide, at}, cv::Scalar(220, 220, 214, 255), 2);
  }
  return net;
}

/// Panels with dark seams and a printed band.
cv::Mat drawBallSkin(std::uint64_t seed) {
  constexpr int kSide = 256;
  const cv::Mat grain = fractalNoise({kSide, kSide}, 6, 2, seed);
  return grey({kSide, kSide}, [&](int x, int y) {
    const float around = static_cast<float>(x) / kSide * 6.2831853f;
    const float up = (static_cast<float>(y) / kSide - 0.5f) * 3.14159265f;
    const float a = std::cos(up) * std::cos(around);
    const float b = std::cos(up) * std::sin(around);
    const float c = std::sin(up);
    const float seam =
        std::min({std::abs(a), std::abs(b), std::abs(c), std::abs(a * a + b * b - 0.5f)});
    const float print = c > 0.25f && c < 0.5f && std::fmod(around, 0.9f) < 0.5f ? 0.45f : 0.95f;
    return (seam < 0.03f ? 0.30f : print) + 0.14f * (grain.at<float>(y, x) - 0.5f);
  });
}

cv::Mat withAlpha(const cv::Mat& picture) {
  cv::Mat rgba;
  if (picture.channels() == 4) {
    rgba = picture.clone();
  } else {
    cv::cvtColor(picture, rgba, cv::COLOR_RGB2RGBA);
  }
  cv::flip(rgba, rgba, 0);
  return rgba;
}

}  // namespace

CoverPictures drawCovers(std::uint64_t seed) {
  CoverPictures covers;
  const auto put = [&](Cover cover, const cv::Mat& picture) {
    covers[static_cast<std::size_t>(cover)] = withAlpha(picture);
  };
  put(Cover::kFloor, drawFloor(seed + 1));
  put(Cover::kBrick, drawBrick(seed + 2));
  put(Cover::kPlank, drawPlanks(seed + 3));
  put(Cover::kPlaster, drawPlaster(seed + 4));
  put(Cover::kCeiling, drawCeiling(seed + 5));
  put(Cover::kWood, drawWood(seed + 6));
  put(Cover::kVinyl, drawVinyl(seed + 7));
  put(Cover::kMetal, drawMetal(seed + 8));
  put(Cover::kPosters, drawPosters(seed + 9));
  put(Cover::kNet, drawNet());
  put(Cover::kBallSkin, drawBallSkin(seed + 10));
  put(Cover::kGlow, cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(255)));
  return covers;
}

cv::Mat drawFloorGrain(std::uint64_t seed) {
  constexpr int kSide = 1024;
  cv::Mat streaks = fractalNoise({128, kSide}, 4, 3, seed);
  cv::resize(streaks, streaks, {kSide, kSide}, 0, 0, cv::INTER_CUBIC);
  const cv::Mat fine = fractalNoise({kSide, kSide}, 40, 6, seed + 1);
  cv::Mat grain = grey({kSide, kSide}, [&](int x, int y) {
    return 0.5f + 0.26f * (streaks.at<float>(y, x) - 0.5f) + 0.14f * (fine.at<float>(y, x) - 0.5f);
  });
  return withAlpha(grain);
}

}  // namespace emulator::studio
