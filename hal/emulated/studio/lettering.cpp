#include "hal/emulated/studio/lettering.h"

#include <algorithm>
#include <memory>

#include <ft2build.h>
#include FT_FREETYPE_H

#include <opencv2/imgproc.hpp>

namespace emulator::studio {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
constexpr double kEmPerCapital = 1.372;  // of DejaVu Sans

struct Font {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Font() {
    if (FT_Init_FreeType(&library) != 0) return;
    if (FT_New_Face(library, kFont, 0, &face) != 0) face = nullptr;
  }
  ~Font() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;
};

void blend(cv::Mat& picture, const FT_Bitmap& glyph, cv::Point at, const cv::Scalar& rgb) {
  for (int y = 0; y < static_cast<int>(glyph.rows); ++y) {
    for (int x = 0; x < static_cast<int>(glyph.width); ++x) {
      const cv::Point to = at + cv::Point(x, y);
      if (!cv::Rect({}, picture.size()).contains(to)) continue;
      const double alpha = glyph.buffer[y * glyph.pitch + x] / 255.0;
      auto& pixel = picture.at<cv::Vec3b>(to);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] * (1 - alpha) + rgb[c] * alpha);
      }
    }
  }
}

/// With a picture draws, without only measures.
int write(cv::Mat* picture, const std::string& text, cv::Point baseline_left, int height_px,
          const cv::Scalar& rgb) {
  const Font font;
  if (font.face == nullptr) {
    const double scale = height_px / 21.0;
    const int thickness = std::max(1, height_px / 9);
    if (picture != nullptr) {
      cv::putText(*picture, text, baseline_left, cv::FONT_HERSHEY_SIMPLEX, scale, rgb, thickness,
                  cv::LINE_AA);
    }
    return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, thickness, nullptr).width;
  }
  FT_Set_Pixel_Sizes(font.face, 0, static_cast<FT_UInt>(height_px * kEmPerCapital));
  int x = baseline_left.x;
  for (const char c : text) {
    if (FT_Load_Char(font.face, static_cast<FT_ULong>(c), FT_LOAD_RENDER) != 0) continue;
    const FT_GlyphSlot glyph = font.face->glyph;
    if (picture != nullptr) {
      blend(*picture, glyph->bitmap, {x + glyph->bitmap_left, baseline_left.y - glyph->bitmap_top},
            rgb);
    }
    x += static_cast<int>(glyph->advance.x >> 6);
  }
  return x - baseline_left.x;
}

}  // namespace

int letter(cv::Mat& picture, const std::string& text, cv::Point baseline_left, int height_px,
           const cv::Scalar& rgb) {
  return write(&picture, text, baseline_left, height_px, rgb);
}

void letterCentred(cv::Mat& picture, const std::string& text, int middle_x, int baseline,
                   int height_px, const cv::Scalar& rgb) {
  const int width = write(nullptr, text, {}, height_px, rgb);
  write(&picture, text, {middle_x - width / 2, baseline}, height_px, rgb);
}

}  // namespace emulator::studio
