#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "ui-kms/film.h"
#include "ui-kms/glyph_atlas.h"

namespace ui {
namespace {

constexpr int kTileWidthPx = 640;
constexpr int kGapPx = 16;
constexpr int kCaptionPx = 44;
constexpr std::uint32_t kTypePx = 20;
const cv::Scalar kPaper(26, 24, 22);
constexpr float kInk = 235;

/// Draws light letters over what is there; too long a caption is cut at the tile's edge.
void write(cv::Mat& tile, GlyphAtlas& atlas, const std::string& text, float x_px, float base_px) {
  std::vector<PlacedGlyph> line;
  static_cast<void>(atlas.shape(text, line));
  // OpenCV has no Mat of constant pixels; these are only read.
  const cv::Mat letters(static_cast<int>(atlas.heightPx()), static_cast<int>(atlas.widthPx()),
                        CV_8UC1, const_cast<std::uint8_t*>(atlas.pixels().data()));
  for (const PlacedGlyph& glyph : line) {
    const int left = static_cast<int>(std::lround(x_px + glyph.x_px));
    const int top = static_cast<int>(std::lround(base_px + glyph.y_px));
    for (int y = 0; y < static_cast<int>(glyph.height_px); ++y) {
      for (int x = 0; x < static_cast<int>(glyph.width_px); ++x) {
        const cv::Point at(left + x, top + y);
        if (!at.inside({0, 0, tile.cols, tile.rows})) continue;
        const cv::Point from(glyph.atlas_x + x, glyph.atlas_y + y);
        const float cover = static_cast<float>(letters.at<uchar>(from)) / 255.0F;
        for (uchar& channel : tile.at<cv::Vec3b>(at).val) {
          channel =
              cv::saturate_cast<uchar>(static_cast<float>(channel) * (1 - cover) + kInk * cover);
        }
      }
    }
  }
}

}  // namespace

std::expected<void, std::string> contactSheet(std::span<const CaptionedStill> stills,
                                              const std::filesystem::path& sheet,
                                              const std::string& font_path) {
  if (stills.empty()) return std::unexpected("contact sheet: no still");
  auto atlas = GlyphAtlas::create(font_path, kTypePx);
  if (!atlas) return std::unexpected(atlas.error());
  std::vector<cv::Mat> tiles;
  int tile_height_px = 0;
  for (const CaptionedStill& still : stills) {
    const cv::Mat picture = cv::imread(still.png.string());
    if (picture.empty()) return std::unexpected("cannot read " + still.png.string());
    const double scale = static_cast<double>(kTileWidthPx) / picture.cols;
    cv::resize(picture, tiles.emplace_back(), {}, scale, scale, cv::INTER_AREA);
    tile_height_px = std::max(tile_height_px, tiles.back().rows);
  }
  const int count = static_cast<int>(tiles.size());
  const int columns = std::min(count, count <= 4 ? 2 : 3);
  const int rows = (count + columns - 1) / columns;
  const int row_px = tile_height_px + kCaptionPx;
  cv::Mat page(kGapPx + rows * (row_px + kGapPx), kGapPx + columns * (kTileWidthPx + kGapPx),
               CV_8UC3, kPaper);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int x = kGapPx + i % columns * (kTileWidthPx + kGapPx);
    const int y = kGapPx + i / columns * (row_px + kGapPx);
    tiles[at].copyTo(page(cv::Rect(x, y, tiles[at].cols, tiles[at].rows)));
    cv::Mat label = page(cv::Rect(x, y + tile_height_px, kTileWidthPx, kCaptionPx));
    write(label, *atlas, stills[at].caption, 2, 28);
  }
  if (!cv::imwrite(sheet.string(), page)) {
    return std::unexpected("cannot write " + sheet.string());
  }
  return {};
}

}  // namespace ui
