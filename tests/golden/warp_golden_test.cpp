#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/golden/golden_display.h"
#include "tests/golden/reference_warp.h"
#include "tests/golden/synthetic_scene.h"

namespace {

constexpr double kEnoughDb = 40;
const cv::Size kLandscape(1280, 1024);
const cv::Size kPortrait(1088, 1920);

class WarpGolden : public testing::Test {
 protected:
  static void expectLikeReference(const Camera& camera, int least_inside) {
    const auto display = makeDisplay();
    ASSERT_NE(display, nullptr);
    const cv::Mat3f picture = shown(*display, &camera.plan);
    const ReferencePicture reference = referenceWarp(camera.plan, camera.demosaiced(), kDisplay);
    EXPECT_GE(cv::countNonZero(reference.inside), least_inside) << "the test shows too little";
    const double inside_db = psnr(picture, reference.rgb, reference.inside);
    RecordProperty("psnr_db", std::to_string(inside_db));
    EXPECT_GE(inside_db, kEnoughDb);
    expectSurround(picture, reference.border);
  }

  static void expectSurround(const cv::Mat3f& picture, const cv::Mat1b& where) {
    // Half a pixel of rounding at the rim belongs to neither side.
    cv::Mat1b core;
    cv::erode(where, core, cv::Mat1b(3, 3, uchar{1}));
    cv::Mat1b grey;
    cv::inRange(picture, cv::Scalar::all(17), cv::Scalar::all(19), grey);
    EXPECT_EQ(cv::countNonZero(core & ~grey), 0)
        << "something else than the surround in the border";
  }
};

constexpr int kAll = 1280 * 720;

TEST_F(WarpGolden, OneToOneIsTheSourceItself) {
  const Camera camera(kLandscape);
  expectLikeReference(camera, kAll);
}

TEST_F(WarpGolden, StrongPerspective) {
  Camera camera(kLandscape);
  camera.look(0.7, 0.15, 0.6);
  expectLikeReference(camera, kAll / 2);
}

TEST_F(WarpGolden, DistortionOfEveryTerm) {
  Camera camera(kLandscape);
  camera.look(1.2, -0.05, 0.1);
  camera.plan.lens.distortion = {-0.28, 0.12, 0.002, -0.0015, -0.02};
  expectLikeReference(camera, kAll / 2);
}

TEST_F(WarpGolden, PortraitCameraOnALandscapeScreen) {
  Camera camera(kPortrait);
  camera.look(1.4, 0.02, -0.1);
  camera.plan.lens.distortion = {-0.08, 0.02, 0.0005, 0.0005, 0};
  expectLikeReference(camera, kAll / 4);
}

TEST_F(WarpGolden, GainsActInLinearLightAndClipAtWhite) {
  Camera camera(kLandscape);
  camera.look(0.9, 0, 0.05);
  camera.plan.colour.gain_rgb = {1.9F, 1.0F, 0.55F};
  expectLikeReference(camera, kAll / 2);
}

/// A camera with a pedestal, a dark rim and a greenish sensor.
hal::ColourModel rawColour() {
  return {.black_level = 6.5F,
          .vignetting = {-0.35F, 0.08F, -0.02F},
          .gain_rgb = {1.2F, 0.9F, 1.1F},
          .matrix = {1.6F, -0.45F, -0.15F, -0.2F, 1.45F, -0.25F, 0.02F, -0.55F, 1.53F}};
}

TEST_F(WarpGolden, TheColourModelActsInItsOrder) {
  Camera camera(kLandscape);
  camera.look(1.1, 0.1, 0.1);  // inner cells and edge cells
  const cv::Mat3f plain = referenceWarp(camera.plan, camera.demosaiced(), kDisplay).rgb;
  camera.plan.colour = rawColour();
  expectLikeReference(camera, kAll / 2);
  const ReferencePicture reference = referenceWarp(camera.plan, camera.demosaiced(), kDisplay);
  EXPECT_LT(psnr(plain, reference.rgb, reference.inside), 30) << "the model changes too little";
}

TEST_F(WarpGolden, ABlackLevelMakesDarkPixelsBlackAndLeavesWhiteAlone) {
  Camera camera(kLandscape);
  std::ranges::fill(camera.mosaic, std::byte{4});
  camera.plan.colour.black_level = 4;
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  EXPECT_LT(cv::norm(shown(*display, &camera.plan), cv::NORM_INF), 1.5);
  std::ranges::fill(camera.mosaic, std::byte{255});
  double darkest = 0;
  cv::minMaxLoc(shown(*display, &camera.plan).reshape(1), &darkest);
  EXPECT_GE(darkest, 254);
}

TEST_F(WarpGolden, BothWaysOfDemosaicingHaveTheSameColourModel) {
  for (const auto site : {ui::DemosaicSite::kCpu, ui::DemosaicSite::kGpu}) {
    cv::Mat3b shades(kLandscape);
    for (int y = 0; y < shades.rows; ++y) {
      for (int x = 0; x < shades.cols; ++x) {
        shades(y, x) = cv::Vec3b(cv::saturate_cast<uchar>(40 + x / 8),
                                 cv::saturate_cast<uchar>(200 - y / 8), 90);
      }
    }
    Camera camera(kLandscape);
    camera.mosaic = mosaicOf(shades, hal::PixelFormat::kBayerRG8);
    camera.plan.source.pixels = camera.mosaic.data();
    camera.plan.colour = rawColour();
    const auto display = makeDisplay(site);
    ASSERT_NE(display, nullptr);
    const ReferencePicture reference = referenceWarp(camera.plan, shades, kDisplay);
    EXPECT_GE(psnr(shown(*display, &camera.plan), reference.rgb, reference.inside), kEnoughDb)
        << "site " << static_cast<int>(site);
  }
}

TEST_F(WarpGolden, TheSoftEdgeIsWhereTheMaskSaysAndGreyBeyondIt) {
  Camera camera(kLandscape);
  camera.look(0.8, 0.05, 0.1);
  for (std::size_t place = 0; place < hal::EdgeMask::kPlaces; ++place)
    camera.plan.edge.narrowing[place] =
        static_cast<float>(1.2 + 0.3 * std::sin(0.3 * static_cast<double>(place)));
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f picture = shown(*display, &camera.plan);
  const ReferencePicture reference = referenceWarp(camera.plan, camera.demosaiced(), kDisplay);
  EXPECT_GE(psnr(picture, reference.rgb, cv::Mat1b(kDisplay, uchar{255})), kEnoughDb);
  EXPECT_NEAR(picture(2, 2)[1], 18, 1);
  EXPECT_NEAR(picture(717, 1277)[1], 18, 1);
}

TEST_F(WarpGolden, BeyondTheLensThereIsBorderAndNoFoldedPicture) {
  Camera camera(kLandscape);
  camera.look(2.2, 0.1, 0.2);
  // r (1 - 0.9 r^2) turns back at r = 0.61: without the limit the picture would come twice.
  camera.plan.lens.distortion = {-0.9, 0, 0, 0, 0};
  camera.plan.lens.max_radius = 0.6;
  camera.plan.lens.fx_px = camera.plan.lens.fy_px = 900;
  expectLikeReference(camera, kAll / 8);
}

TEST_F(WarpGolden, BehindTheCameraThereIsBorder) {
  Camera camera(kLandscape);
  camera.look(0.6, 0, 3.0);  // w changes sign inside the picture
  expectLikeReference(camera, kAll / 8);
}

TEST_F(WarpGolden, AViewSmallerThanACellIsStillFound) {
  Camera camera(kLandscape);
  camera.look(60, 0.3, 0);  // 21 x 17 pixels on the screen
  expectLikeReference(camera, 250);
}

TEST_F(WarpGolden, EveryMosaicComesOutInItsTrueColours) {
  using enum hal::PixelFormat;
  for (const auto format : {kBayerRG8, kBayerGB8, kBayerGR8, kBayerBG8}) {
    for (const auto site : {ui::DemosaicSite::kCpu, ui::DemosaicSite::kGpu}) {
      // Shades so smooth that any right demosaicing gives them back.
      cv::Mat3b shades(kLandscape);
      for (int y = 0; y < shades.rows; ++y) {
        for (int x = 0; x < shades.cols; ++x) {
          shades(y, x) = cv::Vec3b(cv::saturate_cast<uchar>(40 + x / 8),
                                   cv::saturate_cast<uchar>(200 - y / 8), 90);
        }
      }
      Camera camera(kLandscape, format);
      camera.mosaic = mosaicOf(shades, format);
      camera.plan.source.pixels = camera.mosaic.data();
      const auto display = makeDisplay(site);
      ASSERT_NE(display, nullptr);
      const cv::Mat3f picture = shown(*display, &camera.plan);
      const ReferencePicture reference = referenceWarp(camera.plan, shades, kDisplay);
      EXPECT_GE(psnr(picture, reference.rgb, reference.inside), kEnoughDb)
          << "format " << static_cast<int>(format) << " site " << static_cast<int>(site);
    }
  }
}

TEST_F(WarpGolden, MonochromeIsGrey) {
  Camera camera(kLandscape, hal::PixelFormat::kMono8);
  camera.look(0.8, 0.1, 0.1);
  expectLikeReference(camera, kAll / 2);
}

TEST_F(WarpGolden, ShaderDemosaicIsAtLeastAsTrueToTheSceneAsTheCpus) {
  const Camera camera(kLandscape);
  const auto gpu = makeDisplay(ui::DemosaicSite::kGpu);
  const auto cpu = makeDisplay(ui::DemosaicSite::kCpu);
  ASSERT_TRUE(gpu && cpu);
  const ReferencePicture truth = referenceWarp(camera.plan, camera.scene, kDisplay);
  const double gpu_db = psnr(shown(*gpu, &camera.plan), truth.rgb, truth.inside);
  const double cpu_db = psnr(shown(*cpu, &camera.plan), truth.rgb, truth.inside);
  RecordProperty("gpu_db", std::to_string(gpu_db));
  RecordProperty("cpu_db", std::to_string(cpu_db));
  EXPECT_GE(gpu_db, cpu_db);
}

TEST_F(WarpGolden, WithoutAPlanThePictureIsEmpty) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const Camera camera(kLandscape);
  const cv::Mat3f full = shown(*display, &camera.plan);
  EXPECT_GT(cv::countNonZero(full.reshape(1)), kAll);
  const cv::Mat3f empty = shown(*display, nullptr);
  EXPECT_EQ(cv::countNonZero(empty.reshape(1)), 0);
}

TEST_F(WarpGolden, AMissingFontIsNamedAndThePictureGoesOn) {
  const auto display = makeDisplay(ui::DemosaicSite::kCpu, "/nowhere/none.ttf");
  ASSERT_NE(display, nullptr);
  EXPECT_NE(display->textWarning().find("/nowhere/none.ttf"), std::string::npos);
  Camera camera(kLandscape);
  const cv::Mat3f picture = shown(*display, &camera.plan, {.text = "live"});
  const ReferencePicture reference = referenceWarp(camera.plan, camera.demosaiced(), kDisplay);
  EXPECT_GE(psnr(picture, reference.rgb, reference.inside), kEnoughDb);
}

}  // namespace
