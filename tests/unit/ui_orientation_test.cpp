#include <array>

#include <gtest/gtest.h>

#include "ui-kms/orientation.h"

namespace {

using hal::RectPx;
using ui::Orientation;
using ui::SizePx;

constexpr std::array<std::uint32_t, 4> kAll = {0, 90, 180, 270};

TEST(Orientation, OnItsSideAScreensPictureStandsUpright) {
  const SizePx screen{1'920, 1'080};
  EXPECT_EQ(Orientation(0).turned(screen), screen);
  EXPECT_EQ(Orientation(90).turned(screen), (SizePx{1'080, 1'920}));
  EXPECT_EQ(Orientation(180).turned(screen), screen);
  EXPECT_EQ(Orientation(270).turned(screen), (SizePx{1'080, 1'920}));
}

TEST(Orientation, TurnedClockwiseTheScreensTopIsOnTheViewersRight) {
  // The viewer's right edge of a portrait picture is the first row of what is scanned out.
  EXPECT_EQ(Orientation(90).turned(RectPx{1'070, 0, 10, 1'920}, {1'080, 1'920}),
            (RectPx{0, 0, 1'920, 10}));
  EXPECT_EQ(Orientation(270).turned(RectPx{0, 0, 10, 1'920}, {1'080, 1'920}),
            (RectPx{0, 0, 1'920, 10}));
  EXPECT_EQ(Orientation(180).turned(RectPx{0, 1'070, 1'920, 10}, {1'920, 1'080}),
            (RectPx{0, 0, 1'920, 10}));
}

TEST(Orientation, RectanglesAndPointsGoTheSameWay) {
  for (const std::uint32_t rotation_deg : kAll) {
    const Orientation orientation(rotation_deg);
    const SizePx screen{200, 100};
    const SizePx picture = orientation.turned(screen);
    const RectPx pixel{7, 13, 1, 1};
    const auto ndc = orientation.turned((7.5F / static_cast<float>(picture.width)) * 2 - 1,
                                        (13.5F / static_cast<float>(picture.height)) * 2 - 1);
    const RectPx turned = orientation.turned(pixel, picture);
    EXPECT_NEAR((ndc[0] + 1) / 2 * 200, static_cast<float>(turned.x) + 0.5F, 1e-3) << rotation_deg;
    EXPECT_NEAR((ndc[1] + 1) / 2 * 100, static_cast<float>(turned.y) + 0.5F, 1e-3) << rotation_deg;
  }
}

}  // namespace
