#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "ui-kms/film.h"
#include "ui-kms/font_set.h"
#include "ui-kms/glyph_store.h"
#include "ui-kms/text_setter.h"

namespace ui {
namespace {

constexpr int kTileWidthPx = 640;
constexpr int kGapPx = 16;
constexpr int kCaptionPx = 44;
constexpr float kTypePx = 20;
const cv::Scalar kPaper(26, 24, 22);
constexpr float kInk = 235;

/// Letters over pictures in memory, without a graphics driver.
class Captions {
 public:
  explicit Captions(FontSet fonts) : setter_(std::move(fonts), store_) {}

  /// Light letters over what is there; a caption that is too long ends in an ellipsis.
  void write(cv::Mat& tile, const std::string& text, float x_px, float baseline_px) {
    setter_.begin(overlay_);
    setter_.set(overlay_, text,
                {.x_px = x_px,
                 .baseline_px = baseline_px,
                 .width_px = static_cast<float>(tile.cols) - 2 * x_px,
                 .size_px = kTypePx},
                {});
    setter_.finish(overlay_);
    while (store_.tryPopUpload()) {
    }
    store_.adopt(overlay_.generation);
    for (std::uint32_t i = 0; i < overlay_.count; ++i) draw(tile, overlay_.items[i]);
  }

 private:
  void draw(cv::Mat& tile, const hal::OverlayItem& letter) const {
    const auto pixels = store_.pixels(letter.page);
    for (int y = 0; y < static_cast<int>(letter.height_px); ++y) {
      for (int x = 0; x < static_cast<int>(letter.width_px); ++x) {
        const cv::Point at(static_cast<int>(letter.x_px) + x, static_cast<int>(letter.y_px) + y);
        if (!at.inside({0, 0, tile.cols, tile.rows})) continue;
        const std::size_t from =
            std::size_t{GlyphStore::kPagePx} * (letter.v_px + static_cast<std::size_t>(y)) +
            letter.u_px + static_cast<std::size_t>(x);
        const float cover = static_cast<float>(pixels[from]) / 255.0F;
        for (uchar& channel : tile.at<cv::Vec3b>(at).val) {
          channel =
              cv::saturate_cast<uchar>(static_cast<float>(channel) * (1 - cover) + kInk * cover);
        }
      }
    }
  }

  GlyphStore store_;
  TextSetter setter_;
  hal::Overlay overlay_;
};

}  // namespace

std::expected<void, std::string> contactSheet(std::span<const CaptionedStill> stills,
                                              const std::filesystem::path& sheet,
                                              const std::string& font_path) {
  if (stills.empty()) return std::unexpected("contact sheet: no still");
  auto fonts = FontSet::create(font_path);
  if (!fonts) return std::unexpected(fonts.error());
  const auto captions = std::make_unique<Captions>(std::move(*fonts));
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
    captions->write(label, stills[at].caption, 2, 28);
  }
  if (!cv::imwrite(sheet.string(), page)) {
    return std::unexpected("cannot write " + sheet.string());
  }
  return {};
}

}  // namespace ui
