#include "appliance/overlay/status_overlay.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace appliance {
namespace {

constexpr float kLinesPerPicture = 18;
constexpr float kSmallestTypePx = 8;
constexpr float kLineStep = 1.2F;  // of the type size
constexpr hal::OverlayColour kLetters = {247, 247, 242, 255};
constexpr hal::OverlayColour kPlate = {8, 10, 13, 158};
constexpr hal::OverlayColour kBadgeLetters = {20, 13, 0, 255};
constexpr hal::OverlayColour kBadgePlate = {255, 179, 26, 240};

struct Line {
  std::string text;
  float width_px = 0;
};

/// The statements of a text. One that is wider than the picture is divided behind its colon.
std::vector<Line> statementsOf(std::string_view text, float size_px, float room_px,
                               hal::Typesetter& typesetter) {
  std::vector<Line> statements;
  const auto add = [&](std::string_view statement) {
    statements.push_back({std::string(statement), typesetter.widthPx(statement, size_px)});
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(kStatementGap, begin), text.size());
    const std::string_view statement = text.substr(begin, end - begin);
    begin = end + std::string_view(kStatementGap).size();
    const std::size_t colon = statement.find(": ");
    if (colon == std::string_view::npos || typesetter.widthPx(statement, size_px) <= room_px) {
      add(statement);
      continue;
    }
    add(statement.substr(0, colon + 1));
    add(statement.substr(colon + 2));
  }
  return statements;
}

/// As many statements in a line as have room.
std::vector<Line> divide(std::string_view text, float size_px, float room_px,
                         hal::Typesetter& typesetter) {
  std::vector<Line> lines;
  for (const Line& statement : statementsOf(text, size_px, room_px, typesetter)) {
    if (!lines.empty()) {
      Line longer{.text = lines.back().text + kStatementGap + statement.text};
      longer.width_px = typesetter.widthPx(longer.text, size_px);
      if (longer.width_px <= room_px) {
        lines.back() = longer;
        continue;
      }
    }
    lines.push_back(statement);
  }
  return lines;
}

}  // namespace

void addStatusLine(const StatusText& status, std::uint32_t width_px, std::uint32_t height_px,
                   hal::Typesetter& typesetter, hal::Overlay& overlay) {
  if (status.text.empty()) return;
  const auto shorter_px = static_cast<float>(std::min(width_px, height_px));
  const float size_px = std::max(kSmallestTypePx, shorter_px / kLinesPerPicture);
  const float margin_px = shorter_px / 36;
  const float padding_px = shorter_px / 40;
  const float room_px = static_cast<float>(width_px) - 2 * (margin_px + padding_px);
  const std::vector<Line> lines = divide(status.text, size_px, room_px, typesetter);

  const float step_px = size_px * kLineStep;
  const float line_px = typesetter.capHeightPx(size_px) + 2 * padding_px;
  const float height_of_all_px = line_px + static_cast<float>(lines.size() - 1) * step_px;
  const float longest_px = std::min(room_px, std::ranges::max(lines, {}, &Line::width_px).width_px);
  const float bottom_px = static_cast<float>(height_px) - margin_px;
  overlay.add({.kind = hal::OverlayItem::Kind::kPlate,
               .colour = status.warning ? kBadgePlate : kPlate,
               .x_px = margin_px,
               .y_px = bottom_px - height_of_all_px,
               .width_px = longest_px + 2 * padding_px,
               .height_px = height_of_all_px,
               .radius_px = line_px / 4,
               .stroke_px = line_px * 0.075F});
  float baseline_px = bottom_px - padding_px - static_cast<float>(lines.size() - 1) * step_px;
  for (const Line& line : lines) {
    typesetter.set(overlay, line.text,
                   {.x_px = margin_px + padding_px,
                    .baseline_px = baseline_px,
                    .width_px = room_px,
                    .size_px = size_px},
                   status.warning ? kBadgeLetters : kLetters);
    baseline_px += step_px;
  }
}

}  // namespace appliance
