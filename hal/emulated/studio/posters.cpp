#include "hal/emulated/studio/posters.h"

#include <array>
#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/lettering.h"
#include "hal/emulated/studio/noise.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

constexpr int kSheetPx = 2048;
constexpr std::uint32_t kPortraits = 10;
constexpr std::uint32_t kBanners = 4;
constexpr std::uint32_t kScoreboard = kPortraits + kBanners;
constexpr std::uint32_t kClock = kScoreboard + 1;

cv::Rect areaOf(std::uint32_t poster) {
  const int i = static_cast<int>(poster);
  if (poster < kPortraits) return {i % 5 * 400 + 4, i / 5 * 512 + 4, 358, 504};
  if (poster < kScoreboard) {
    const int banner = i - static_cast<int>(kPortraits);
    return {banner % 2 * 1024 + 4, 1024 + banner / 2 * 256 + 4, 1016, 248};
  }
  if (poster == kScoreboard) return {4, 1540, 1016, 500};
  return {1028, 1540, 500, 500};
}

using Colour = cv::Scalar;

/// A running figure that throws, as sports graphics draw them: limbs as thick strokes.
void drawFigure(cv::Mat& to, cv::Point2f at, float size, const Colour& rgb, bool mirrored) {
  const auto p = [&](float x, float y) {
    return cv::Point(static_cast<int>(at.x + (mirrored ? -x : x) * size),
                     static_cast<int>(at.y + y * size));
  };
  const auto limb = [&](float width, std::initializer_list<cv::Point> points) {
    const cv::Point* previous = nullptr;
    for (const cv::Point& point : points) {
      if (previous != nullptr)
        cv::line(to, *previous, point, rgb, std::max(1, static_cast<int>(width * size)),
                 cv::LINE_AA);
      previous = &point;
    }
  };
  cv::circle(to, p(0.06f, -0.80f), static_cast<int>(0.085f * size), rgb, cv::FILLED, cv::LINE_AA);
  limb(0.19f, {p(0.02f, -0.62f), p(-0.05f, -0.32f)});
  limb(0.11f, {p(-0.03f, -0.30f), p(0.22f, -0.18f), p(0.16f, 0.08f), p(0.27f, 0.10f)});
  limb(0.11f, {p(-0.06f, -0.30f), p(-0.20f, -0.05f), p(-0.45f, 0.02f), p(-0.48f, 0.10f)});
  limb(0.075f, {p(-0.05f, -0.66f), p(-0.28f, -0.72f), p(-0.34f, -0.98f)});
  limb(0.075f, {p(0.08f, -0.64f), p(0.30f, -0.55f), p(0.50f, -0.66f)});
  cv::circle(to, p(-0.37f, -1.06f), static_cast<int>(0.075f * size), rgb, cv::FILLED, cv::LINE_AA);
}

/// Something like a photograph: sky, hills and grain.
void drawPhotograph(cv::Mat& to, const Colour& tint, std::uint64_t seed) {
  const cv::Mat noise = fractalNoise(to.size(), 96, 6, seed);
  Random random(seed);
  const float slope = random.uniform(-0.15f, 0.15f);
  for (int y = 0; y < to.rows; ++y) {
    for (int x = 0; x < to.cols; ++x) {
      const float h = static_cast<float>(y) / static_cast<float>(to.rows);
      const float n = noise.at<float>(y, x);
      const float ridge = 0.55f +
                          slope * (static_cast<float>(x) / static_cast<float>(to.cols) - 0.5f) +
                          0.35f * (noise.at<float>(0, x) - 0.5f);
      const float sky = 1 - 0.55f * h + 0.25f * (n - 0.5f);
      const float land = 0.25f + 0.5f * n * (1.2f - h);
      const float value = h < ridge ? sky : land;
      auto& pixel = to.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        const double shade = h < ridge ? tint[c] * 0.5 + 127 : tint[c];
        pixel[c] = cv::saturate_cast<std::uint8_t>(shade * value);
      }
    }
  }
}

void drawSmallPrint(cv::Mat& to, cv::Rect area, int line_px, const Colour& rgb, Random& random) {
  for (int y = area.y; y + line_px < area.br().y; y += line_px * 2) {
    int x = area.x;
    const int end =
        area.br().x - static_cast<int>(random.uniform(0, 0.4f) * static_cast<float>(area.width));
    std::string words;
    while (x < end) {
      words += static_cast<char>('a' + random.next() % 26);
      if (random.unit() < 0.2) words += ' ';
      x += line_px * 3 / 4;
    }
    letter(to, words, {area.x, y + line_px}, line_px, rgb);
  }
}

void drawPortrait(cv::Mat to, std::uint32_t number, std::uint64_t seed) {
  struct Look {
    const char* title;
    const char* line;
    Colour paper;
    Colour ink;
  };
  static const std::array<Look, kPortraits> kLooks = {{
      {"SPRING", "HANDBALL CUP", {196, 58, 40}, {250, 240, 220}},
      {"FAIR PLAY", "ALWAYS", {240, 236, 224}, {30, 70, 140}},
      {"JUMP", "24 MAY  19:00", {28, 60, 110}, {250, 210, 60}},
      {"WARM UP", "10 MINUTES", {246, 214, 70}, {40, 40, 44}},
      {"U16 TEAM", "2025 / 26", {32, 96, 70}, {240, 240, 230}},
      {"THROW", "FAST AND SAFE", {230, 230, 234}, {170, 30, 40}},
      {"CITY RUN", "10 km  5 km", {235, 130, 50}, {30, 30, 40}},
      {"RULES", "OF THIS HALL", {250, 250, 246}, {40, 44, 52}},
      {"SUMMER", "CAMP", {90, 170, 210}, {250, 250, 250}},
      {"FIRST AID", "DIAL 112", {250, 250, 250}, {20, 130, 70}},
  }};
  const Look& look = kLooks[number];
  Random random(seed + number);
  to.setTo(look.paper);
  const int w = to.cols;
  const int h = to.rows;
  if (number % 3 == 0 || number == 8) {
    cv::Mat photograph = to(cv::Rect(0, h / 5, w, h * 11 / 20));
    drawPhotograph(photograph, look.ink, seed + number);
  }
  if (number == 2 || number == 6) {
    for (int i = 0; i < 9; ++i)
      cv::line(to, {w / 2, h * 3 / 5}, {w * i / 8, h / 6}, look.ink * 0.6, 3 + i, cv::LINE_AA);
  }
  if (number != 7 && number != 9)
    drawFigure(to, {static_cast<float>(w) * 0.5f, static_cast<float>(h) * 0.70f},
               static_cast<float>(h) * 0.40f, look.ink, number % 2 == 0);
  if (number == 7) {
    for (int i = 0; i < 7; ++i) {
      cv::circle(to, {34, 130 + i * 44}, 13, Colour(200, 40, 40), 3, cv::LINE_AA);
      letter(to, std::to_string(i + 1), {28, 137 + i * 44}, 14, look.ink);
      drawSmallPrint(to, {62, 116 + i * 44, w - 80, 36}, 9, look.ink, random);
    }
  }
  if (number == 9) {
    cv::rectangle(to, {w / 2 - 40, 150, 80, 230}, look.ink, cv::FILLED);
    cv::rectangle(to, {w / 2 - 115, 225, 230, 80}, look.ink, cv::FILLED);
  }
  letterCentred(to, look.title, w / 2, 74,
                std::min(52, 330 / static_cast<int>(std::string(look.title).size())), look.ink);
  cv::line(to, {24, 90}, {w - 24, 90}, look.ink, 3);
  letterCentred(to, look.line, w / 2, h - 62, 22, number % 3 == 0 ? look.ink : look.ink * 0.8);
  if (number != 7) drawSmallPrint(to, {26, h - 48, w - 52, 40}, 8, look.ink, random);
  cv::rectangle(to, {0, 0, w, h}, Colour(250, 250, 250), number % 2 == 0 ? 8 : 2);
}

void drawBanner(cv::Mat to, std::uint32_t number) {
  struct Look {
    const char* text;
    const char* small;
    Colour paper;
    Colour ink;
  };
  static const std::array<Look, kBanners> kLooks = {{
      {"LINDENTAL", "HANDBALL CLUB SINCE 1948", {24, 46, 104}, {250, 250, 250}},
      {"NORDBANK", "PARTNER OF SPORT", {180, 28, 36}, {252, 240, 210}},
      {"aquaform", "drink before you are thirsty", {235, 240, 240}, {10, 110, 150}},
      {"CHAMPIONS 2019", "REGIONAL LEAGUE WOMEN", {240, 196, 40}, {30, 30, 34}},
  }};
  const Look& look = kLooks[number];
  to.setTo(look.paper);
  const int w = to.cols;
  const int h = to.rows;
  const int height = std::min(104, 760 / static_cast<int>(std::string(look.text).size()));
  letterCentred(to, look.text, w / 2 + 60, h / 2 + height / 2 - 22, height, look.ink);
  letterCentred(to, look.small, w / 2 + 60, h - 28, 24, look.ink);
  drawFigure(to, {110, static_cast<float>(h) * 0.86f}, static_cast<float>(h) * 0.66f, look.ink,
             number % 2 == 1);
  for (int i = 0; i < 5; ++i)
    cv::line(to, {w - 16 - 22 * i, 0}, {w - 90 - 22 * i, h}, look.ink * 0.75, 7, cv::LINE_AA);
  cv::rectangle(to, {0, 0, w, h}, look.ink, 4);
  for (int x = 30; x < w; x += 160) {
    for (const int y : {10, h - 10})
      cv::circle(to, {x, y}, 5, Colour(130, 130, 130), cv::FILLED, cv::LINE_AA);
  }
}

void drawScoreboard(cv::Mat to) {
  to.setTo(Colour(22, 24, 28));
  const Colour red(235, 60, 40);
  const Colour amber(250, 190, 60);
  cv::rectangle(to, {6, 6, to.cols - 12, to.rows - 12}, Colour(120, 124, 130), 6);
  letterCentred(to, "HOME", 210, 90, 46, Colour(235, 235, 235));
  letterCentred(to, "GUESTS", 806, 90, 46, Colour(235, 235, 235));
  letterCentred(to, "17", 210, 300, 150, red);
  letterCentred(to, "14", 806, 300, 150, red);
  letterCentred(to, "08:26", 508, 190, 64, amber);
  letterCentred(to, "2", 508, 320, 80, amber);
  letterCentred(to, "PERIOD", 508, 366, 24, Colour(235, 235, 235));
  letterCentred(to, "PENALTY", 210, 370, 24, Colour(235, 235, 235));
  letterCentred(to, "PENALTY", 806, 370, 24, Colour(235, 235, 235));
  for (const int x : {120, 210, 300, 716, 806, 896})
    cv::circle(to, {x, 420}, 17, x == 120 ? red : Colour(60, 20, 18), cv::FILLED, cv::LINE_AA);
}

void drawClock(cv::Mat to) {
  to.setTo(Colour(214, 216, 212));
  const cv::Point middle(to.cols / 2, to.rows / 2);
  cv::circle(to, middle, 240, Colour(250, 250, 248), cv::FILLED, cv::LINE_AA);
  cv::circle(to, middle, 240, Colour(40, 42, 46), 14, cv::LINE_AA);
  for (int i = 0; i < 60; ++i) {
    const double a = i * 3.14159265358979 / 30;
    const cv::Point2d direction(std::sin(a), -std::cos(a));
    const double inner = i % 5 == 0 ? 180 : 205;
    cv::line(to, middle + cv::Point(direction * inner), middle + cv::Point(direction * 220),
             Colour(30, 30, 32), i % 5 == 0 ? 14 : 5, cv::LINE_AA);
  }
  cv::line(to, middle, middle + cv::Point(-70, -95), Colour(20, 20, 22), 18, cv::LINE_AA);
  cv::line(to, middle, middle + cv::Point(150, -110), Colour(20, 20, 22), 12, cv::LINE_AA);
  cv::line(to, middle, middle + cv::Point(-30, 190), Colour(190, 20, 20), 5, cv::LINE_AA);
}

}  // namespace

PosterPlace posterPlace(std::uint32_t poster) {
  const cv::Rect area = areaOf(poster);
  const auto v = [](int y) { return 1 - static_cast<float>(y) / kSheetPx; };
  const auto u = [](int x) { return static_cast<float>(x) / kSheetPx; };
  return {.low = {u(area.x), v(area.br().y)},
          .high = {u(area.br().x), v(area.y)},
          .aspect = static_cast<float>(area.width) / static_cast<float>(area.height)};
}

std::vector<HungPoster> hungPosters() {
  return {
      {0, Wall::kBack, -3.35f, 1.15f, 1.25f}, {1, Wall::kBack, -2.2f, 1.05f, 1.35f},
      {3, Wall::kBack, -1.15f, 1.2f, 1.15f},  {2, Wall::kBack, 1.0f, 1.1f, 1.3f},
      {5, Wall::kBack, 2.05f, 1.05f, 1.4f},   {4, Wall::kBack, 4.9f, 1.1f, 1.25f},
      {9, Wall::kBack, 8.75f, 1.3f, 0.7f},    {7, Wall::kBack, 5.75f, 1.2f, 1.1f},
      {6, Wall::kBack, 8.0f, 1.2f, 1.2f},     {10, Wall::kBack, -4.6f, 3.45f, 0.95f},
      {11, Wall::kBack, 4.3f, 3.45f, 0.8f},   {13, Wall::kBack, 7.9f, 3.5f, 0.75f},
      {14, Wall::kBack, -1.7f, 4.5f, 1.1f},   {15, Wall::kBack, 2.6f, 4.55f, 0.7f},
      {8, Wall::kLeft, 5.6f, 0.9f, 1.3f},     {6, Wall::kLeft, 4.35f, 0.95f, 1.2f},
      {0, Wall::kLeft, -1.0f, 1.0f, 1.3f},    {12, Wall::kLeft, 4.4f, 2.85f, 0.95f},
      {10, Wall::kLeft, -0.8f, 2.9f, 0.9f},   {5, Wall::kLeft, -4.8f, 1.0f, 1.2f},
      {2, Wall::kRight, 6.2f, 0.95f, 1.3f},   {3, Wall::kRight, 4.9f, 1.0f, 1.2f},
      {1, Wall::kRight, 0.4f, 1.0f, 1.3f},    {8, Wall::kRight, -1.1f, 1.0f, 1.25f},
      {11, Wall::kRight, 3.0f, 2.75f, 0.9f},  {12, Wall::kRight, -3.6f, 2.8f, 0.9f},
  };
}

cv::Mat drawPosters(std::uint64_t seed) {
  cv::Mat sheet(kSheetPx, kSheetPx, CV_8UC3, Colour(128, 128, 128));
  for (std::uint32_t i = 0; i < kPortraits; ++i) drawPortrait(sheet(areaOf(i)), i, seed);
  for (std::uint32_t i = 0; i < kBanners; ++i) drawBanner(sheet(areaOf(kPortraits + i)), i);
  drawScoreboard(sheet(areaOf(kScoreboard)));
  drawClock(sheet(areaOf(kClock)));
  return sheet;
}

}  // namespace emulator::studio
