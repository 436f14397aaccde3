#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/golden/golden_display.h"
#include "tests/golden/reference_warp.h"

namespace {

using hal::Overlay;
using hal::OverlayColour;
using hal::OverlayItem;
using hal::Typesetter;

constexpr OverlayColour kWhite{255, 255, 255, 255};
const char* const kJapaneseFont = "/usr/share/fonts/opentype/ipaexfont-gothic/ipaexg.ttf";

class OverlayGolden : public testing::Test {
 protected:
  template <class Draw>
  static cv::Mat3f drawn(ui::OffscreenDisplay& display, Draw draw) {
    const auto overlay = overlayOf(display, draw);
    return shownScene(display, {.overlay = overlay.get()});
  }

  static std::unique_ptr<ui::OffscreenDisplay> turnedBy(std::uint32_t rotation_deg) {
    ui::RendererConfig config;
    config.rotation_deg = rotation_deg;
    config.demosaic = ui::DemosaicSite::kCpu;
    return openDisplay(config);
  }

  static cv::Rect litIn(const cv::Mat3f& picture) {
    cv::Mat1b lit;
    cv::inRange(picture, cv::Scalar::all(60), cv::Scalar::all(255), lit);
    return cv::boundingRect(lit);
  }
};

TEST_F(OverlayGolden, StatusLineIsLightOnADarkPlateAndTellsTextsApart) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  ASSERT_EQ(display->textWarning(), "");
  const cv::Mat3f live = shown(*display, nullptr, {.text = "live"});
  const cv::Mat3f frozen = shown(*display, nullptr, {.text = "frozen"});
  double brightest = 0;
  cv::minMaxLoc(live.reshape(1), nullptr, &brightest);
  EXPECT_GT(brightest, 220);
  EXPECT_GT(cv::norm(live, frozen, cv::NORM_L1), 100'000);
  // It keeps to the foot of the picture.
  EXPECT_EQ(cv::countNonZero(live.rowRange(0, 600).clone().reshape(1)), 0);
}

TEST_F(OverlayGolden, StatusLettersAreReadableFromFiveMetres) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f picture = shown(*display, nullptr, {.text = "H"});
  cv::Mat1b bright;
  cv::inRange(picture, cv::Scalar::all(200), cv::Scalar::all(255), bright);
  const cv::Rect letter = cv::boundingRect(bright);
  EXPECT_GE(letter.height, kDisplay.height / 26);  // a capital is 0.7 of the type size
  EXPECT_LE(letter.height, kDisplay.height / 18);
}

TEST_F(OverlayGolden, AWarningIsABadgeOfAnotherColour) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f plain = shown(*display, nullptr, {.text = "camera 8"});
  const cv::Mat3f badge = shown(*display, nullptr, {.text = "camera 8", .warning = true});
  const auto amber = [](const cv::Mat3f& picture) {
    cv::Mat1b mask;
    cv::inRange(picture, cv::Scalar(200, 120, 0), cv::Scalar(255, 200, 90), mask);
    return cv::countNonZero(mask);
  };
  EXPECT_EQ(amber(plain), 0);
  EXPECT_GT(amber(badge), 2'000);
}

TEST_F(OverlayGolden, ALineThatIsTooLongIsDividedBetweenStatements) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const std::string badge = "LIVE   view 7/20   camera 7 has no picture of this moment: showing 8";
  const cv::Mat3f picture = shown(*display, nullptr, {.text = badge, .warning = true});
  keepPicture("two_lines", picture);
  cv::Mat1b amber;
  cv::inRange(picture, cv::Scalar(200, 120, 0), cv::Scalar(255, 200, 90), amber);
  const cv::Rect plate = cv::boundingRect(amber);
  EXPECT_GT(plate.height, kDisplay.height / 8);  // two lines
  EXPECT_LE(plate.br().x, kDisplay.width - kDisplay.height / 40);
}

TEST_F(OverlayGolden, ATextThatIsLongerThanItsBoxEndsInAnEllipsis) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  float width_px = 0;
  const cv::Mat3f picture = drawn(*display, [&](Typesetter& typesetter, Overlay& overlay) {
    width_px =
        typesetter.set(overlay, std::string(200, 'W'),
                       {.x_px = 100, .baseline_px = 300, .width_px = 400, .size_px = 40}, kWhite);
  });
  keepPicture("ellipsis", picture);
  EXPECT_LE(width_px, 400);
  EXPECT_GT(width_px, 300);
  const cv::Rect lit = litIn(picture);
  EXPECT_GE(lit.x, 99);
  EXPECT_LE(lit.br().x, 501);
  // Three dots on the baseline, and nothing above them.
  const cv::Rect dots(lit.br().x - 12, lit.y, 12, 20);
  EXPECT_EQ(cv::countNonZero(cv::Mat3f(picture(dots)).clone().reshape(1)), 0);
}

TEST_F(OverlayGolden, JapaneseStandsInItsBox) {
  if (!std::filesystem::exists(kJapaneseFont)) {
    GTEST_SKIP() << "no Japanese font here: install fonts-ipaexfont-gothic";
  }
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  float width_px = 0;
  const cv::Mat3f picture = drawn(*display, [&](Typesetter& typesetter, Overlay& overlay) {
    width_px =
        typesetter.set(overlay, "停止 −1.25 s   カメラ 7 の映像なし",
                       {.x_px = 100, .baseline_px = 300, .width_px = 900, .size_px = 40}, kWhite);
    EXPECT_EQ(typesetter.takeWarning(), "");
  });
  keepPicture("japanese", picture);
  const cv::Rect lit = litIn(picture);
  EXPECT_GE(lit.x, 99);
  EXPECT_LE(lit.br().x, 101 + static_cast<int>(width_px));
  EXPECT_GT(lit.width, 500);
  EXPECT_GE(lit.y, 300 - 40);
  EXPECT_LE(lit.br().y, 300 + 12);
}

TEST_F(OverlayGolden, MarksAreWhereTheyAreAskedFor) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f picture = drawn(*display, [](Typesetter&, Overlay& overlay) {
    overlay.add({.kind = OverlayItem::Kind::kPlate,
                 .colour = {255, 0, 0, 255},
                 .x_px = 100,
                 .y_px = 100,
                 .width_px = 80,
                 .height_px = 40,
                 .stroke_px = 0});
    overlay.add({.kind = OverlayItem::Kind::kRing,
                 .colour = {0, 255, 0, 255},
                 .x_px = 300,
                 .y_px = 100,
                 .width_px = 100,
                 .height_px = 100,
                 .radius_px = 50,
                 .stroke_px = 6});
    overlay.add({.kind = OverlayItem::Kind::kLine,
                 .x_px = 500,
                 .y_px = 100,
                 .width_px = 100,
                 .height_px = 100,
                 .stroke_px = 5});
    addCross(overlay, 700, 150, 60, 4, kWhite);
  });
  keepPicture("marks", picture);
  EXPECT_EQ(picture(120, 140), cv::Vec3f(255, 0, 0));
  EXPECT_EQ(picture(120, 90), cv::Vec3f(0, 0, 0));
  EXPECT_EQ(picture(150, 303), cv::Vec3f(0, 255, 0));  // the ring's left side
  EXPECT_EQ(picture(150, 350), cv::Vec3f(0, 0, 0));    // its middle
  EXPECT_EQ(picture(105, 305), cv::Vec3f(0, 0, 0));    // beyond its round corner
  EXPECT_EQ(picture(150, 550), cv::Vec3f(255, 255, 255));
  EXPECT_EQ(picture(150, 570), cv::Vec3f(0, 0, 0));
  EXPECT_EQ(picture(150, 680), cv::Vec3f(255, 255, 255));
  EXPECT_EQ(picture(130, 700), cv::Vec3f(255, 255, 255));
  EXPECT_EQ(picture(130, 680), cv::Vec3f(0, 0, 0));
}

TEST_F(OverlayGolden, AHalfOpaquePlateLetsThePictureThrough) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  Camera camera({1280, 1024});
  const cv::Mat3f bare = shown(*display, &camera.plan);
  const auto overlay = overlayOf(*display, [](Typesetter&, Overlay& filled) {
    filled.add({.kind = OverlayItem::Kind::kPlate,
                .colour = {0, 0, 0, 128},
                .width_px = 1280,
                .height_px = 720,
                .stroke_px = 0});
  });
  hal::Scene scene{.count = 1, .overlay = overlay.get()};
  scene.layers[0].plan = camera.plan;
  const cv::Mat3f dimmed = shownScene(*display, scene);
  EXPECT_LT(cv::norm(dimmed, bare * (127.0 / 255), cv::NORM_INF), 1.1);
}

/// The picture of a turned screen is the same, upright; only its shape is another.
TEST_F(OverlayGolden, ATurnedScreenShowsTheSamePictureUpright) {
  for (const std::uint32_t rotation_deg : {90U, 180U, 270U}) {
    SCOPED_TRACE(rotation_deg);
    const auto display = turnedBy(rotation_deg);
    ASSERT_NE(display, nullptr);
    const hal::DisplayMode mode = display->mode();
    const cv::Size size(static_cast<int>(mode.width_px), static_cast<int>(mode.height_px));
    EXPECT_EQ(size, rotation_deg == 180 ? cv::Size(1280, 720) : cv::Size(720, 1280));
    Camera camera({1280, 1400});
    camera.plan.H_camera_display = {1.02, 0.03, 20, -0.02, 1.01, 40, 1e-5, 2e-5, 1};
    hal::Scene scene{.count = 2};
    scene.layers[0].plan = camera.plan;
    scene.layers[0].where = {0, 0, size.width, 300};
    scene.layers[1].plan = camera.plan;
    scene.layers[1].where = {0, 300, 500, size.height - 300};
    const cv::Mat3f picture = shownScene(*display, scene);
    const cv::Mat3b source = camera.demosaiced();
    const std::vector<ReferenceLayer> layers = {{scene.layers[0], source},
                                                {scene.layers[1], source}};
    EXPECT_GE(psnr(picture, referenceScene(layers, size), cv::Mat1b(size, uchar{255})), 40);
    const cv::Mat3f text = shown(*display, &camera.plan,
                                 {.text = "LIVE   view 7/20   camera 7 lost: showing its last "
                                          "picture",
                                  .warning = true});
    keepPicture("turned_" + std::to_string(rotation_deg), text);
    const cv::Rect foot(0, size.height * 3 / 4, size.width, size.height / 4);
    cv::Mat1b amber;
    cv::inRange(text, cv::Scalar(200, 120, 0), cv::Scalar(255, 200, 90), amber);
    EXPECT_GT(cv::countNonZero(amber(foot)), 10'000);
    EXPECT_LT(cv::countNonZero(amber) - cv::countNonZero(amber(foot)), 2'000);
  }
}

/// What is scanned out, against what the viewer sees: one pixel says which way it is turned.
TEST_F(OverlayGolden, TurnedBy90TheScreensOwnTopIsOnTheViewersRight) {
  auto renderer = ui::Renderer::create({.width_px = 128, .height_px = 64, .rotation_deg = 90});
  ASSERT_TRUE(renderer) << renderer.error();
  const auto target = ui::makeRenderTarget(128, 64);
  ASSERT_TRUE(target) << target.error();
  const auto overlay = std::make_unique<Overlay>();
  overlay->add({.kind = OverlayItem::Kind::kPlate, .width_px = 8, .height_px = 8, .stroke_px = 0});
  overlay->generation = 99;
  (*renderer)->draw(*target, {.overlay = overlay.get()});
  cv::Mat4b scanned_out(64, 128);
  ASSERT_TRUE(ui::readTarget(*target, {}, {},
                             {reinterpret_cast<std::byte*>(scanned_out.data), 64U * 128 * 4}));
  EXPECT_EQ(scanned_out(60, 4)[0], 255);  // the viewer's top left is the screen's bottom left
  EXPECT_EQ(scanned_out(4, 4)[0], 0);
}

}  // namespace
