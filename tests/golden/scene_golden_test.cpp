#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/golden/golden_display.h"
#include "tests/golden/reference_warp.h"

namespace {

constexpr double kEnoughDb = 40;
const cv::Size kFrame(1280, 1024);
const cv::Mat1b kEverywhere(kDisplay, uchar{255});
const hal::RectPx kLeft{0, 0, 640, 720};
const cv::Vec3f kSurround = cv::Vec3f::all(18);  // what lies around every camera's picture
const hal::RectPx kRight{640, 0, 640, 720};

/// Two cameras that see other things, and a scene of layers with their frames.
class SceneGolden : public testing::Test {
 protected:
  SceneGolden() {
    first_.look(0.9, 0.05, 0.1);
    second_.look(0.8, -0.2, -0.1);
    second_.plan.colour.gain_rgb = {0.5F, 0.9F, 1.6F};  // some of it clips
  }

  static hal::ViewLayer layer(const Camera& camera, const hal::RectPx& where = hal::kWholePicture,
                              float opacity = 1, std::uint64_t content = 0) {
    return {.plan = camera.plan, .where = where, .opacity = opacity, .content = content};
  }

  static hal::Scene scene(const std::vector<hal::ViewLayer>& layers) {
    hal::Scene scene;
    for (const hal::ViewLayer& layer : layers) scene.layers[scene.count++] = layer;
    return scene;
  }

  [[nodiscard]] cv::Mat3f reference(const std::vector<hal::ViewLayer>& layers) const {
    const std::array<cv::Mat3b, 2> sources = {first_.demosaiced(), second_.demosaiced()};
    std::vector<ReferenceLayer> all;
    for (const hal::ViewLayer& layer : layers) {
      const bool first = layer.plan.source.pixels == first_.plan.source.pixels;
      all.push_back({layer, sources[first ? 0 : 1]});
    }
    return referenceScene(all, kDisplay);
  }

  void expectLikeReference(const std::string& name, const std::vector<hal::ViewLayer>& layers,
                           ui::BlendTarget::Storage blending = {}) const {
    ui::RendererConfig config;
    config.demosaic = ui::DemosaicSite::kCpu;
    config.blending = blending;
    const auto display = openDisplay(config);
    ASSERT_NE(display, nullptr);
    const cv::Mat3f picture = shownScene(*display, scene(layers));
    keepPicture(name, picture);
    const double db = psnr(picture, reference(layers), kEverywhere);
    RecordProperty("psnr_db", std::to_string(db));
    EXPECT_GE(db, kEnoughDb);
  }

  Camera first_{kFrame};
  Camera second_{kFrame, hal::PixelFormat::kBayerGR8};
};

TEST_F(SceneGolden, SideBySideEachLayerKeepsToItsHalf) {
  expectLikeReference("side_by_side", {layer(first_, kLeft), layer(second_, kRight)});
}

TEST_F(SceneGolden, AWipeCutsAtAnyColumn) {
  expectLikeReference("wipe",
                      {layer(first_, {0, 0, 501, 720}), layer(second_, {501, 0, 779, 720})});
}

TEST_F(SceneGolden, AGhostIsAMixtureInLinearLight) {
  expectLikeReference("ghost", {layer(first_), layer(second_, hal::kWholePicture, 0.4F)});
}

TEST_F(SceneGolden, AGhostIsTheSameWhereTheDriverDrawsNoHalfFloats) {
  expectLikeReference("ghost_srgb", {layer(first_), layer(second_, hal::kWholePicture, 0.4F)},
                      ui::BlendTarget::Storage::kSrgbBytes);
}

TEST_F(SceneGolden, ALayerAboveHidesWhatItSeesAndNoMore) {
  second_.look(3.0, 0.3, 0.2);  // smaller than its rectangle: its border lets the lower one through
  expectLikeReference("picture_in_picture", {layer(first_), layer(second_, {200, 100, 700, 500})});
}

TEST_F(SceneGolden, FourLayersOfOneSizeKeepTheirOwnFrames) {
  expectLikeReference(
      "four", {layer(first_, {0, 0, 640, 360}), layer(second_, {640, 0, 640, 360}),
               layer(second_, {0, 360, 640, 360}, 0.5F), layer(first_, {640, 360, 640, 360})});
}

TEST_F(SceneGolden, CamerasOfDifferentSizesShareAPicture) {
  second_ = Camera({1088, 1920}, hal::PixelFormat::kBayerGR8);
  second_.look(1.2, 0.05, 0.1);
  expectLikeReference("sizes", {layer(first_, kLeft), layer(second_, kRight)});
}

TEST_F(SceneGolden, AfterAChangeOfTheScreenThePictureIsThatOfANewRenderer) {
  const auto pictureOf = [this](ui::Renderer& renderer) {
    const auto target = ui::makeRenderTarget(1280, 720);
    EXPECT_TRUE(target) << target.error();
    renderer.draw(*target, scene({layer(first_), layer(second_, kRight, 0.5F)}));
    std::vector<std::byte> rgba(std::size_t{4} * 1280 * 720);
    EXPECT_TRUE(renderer.read(*target, rgba));
    return rgba;
  };
  auto another = ui::Renderer::create({.width_px = 640, .height_px = 480});
  ASSERT_TRUE(another) << another.error();
  ASSERT_TRUE((*another)->resize(1280, 720));
  const auto resized = pictureOf(**another);
  const auto fresh = ui::Renderer::create({.width_px = 1280, .height_px = 720});
  ASSERT_TRUE(fresh) << fresh.error();
  EXPECT_TRUE(resized == pictureOf(**fresh));
}

TEST_F(SceneGolden, AScreenThatIsLargerThanTheDriverCanDrawIsNamed) {
  const auto renderer = ui::Renderer::create({.width_px = 1'000'000, .height_px = 16});
  ASSERT_FALSE(renderer);
  EXPECT_NE(renderer.error().find("1000000x16"), std::string::npos) << renderer.error();
}

TEST_F(SceneGolden, AWholeLayerOfFullOpacityIsTheSinglePassItself) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f single = shown(*display, &first_.plan);
  const cv::Mat3f covered = shownScene(
      *display, scene({layer(first_), layer(second_, {0, 0, 0, 0}), layer(second_, kLeft, 0)}));
  EXPECT_EQ(cv::norm(single, covered, cv::NORM_INF), 0);
}

TEST_F(SceneGolden, WhatLiesOutsideThePictureIsCutOff) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f whole = shown(*display, &first_.plan);
  const cv::Mat3f larger = shownScene(*display, scene({layer(first_, {-500, -9, 5'000, 3'000})}));
  EXPECT_EQ(cv::norm(whole, larger, cv::NORM_INF), 0);
  const cv::Mat3f beside = shownScene(*display, scene({layer(first_, {1'280, 0, 10, 10})}));
  EXPECT_EQ(cv::norm(beside, cv::Mat3f(beside.size(), kSurround), cv::NORM_INF), 0);
}

TEST_F(SceneGolden, AFrameIsLoadedOnceUnderItsName) {
  for (const auto site : {ui::DemosaicSite::kCpu, ui::DemosaicSite::kGpu}) {
    const auto display = makeDisplay(site);
    ASSERT_NE(display, nullptr);
    const cv::Mat3f before = shownScene(*display, scene({layer(first_, kLeft, 1, 7)}));
    std::vector<std::byte> pixels = first_.mosaic;
    std::ranges::fill(first_.mosaic, std::byte{0});
    EXPECT_EQ(
        cv::norm(shownScene(*display, scene({layer(first_, kLeft, 1, 7)})), before, cv::NORM_INF),
        0);
    const cv::Mat3f dark = shownScene(*display, scene({layer(first_, kLeft, 1, 8)}));
    EXPECT_EQ(cv::norm(dark, cv::NORM_INF), kSurround[0]) << "no more light than around it";
    first_.mosaic = std::move(pixels);
    first_.plan.source.pixels = first_.mosaic.data();
  }
}

TEST_F(SceneGolden, TheNewestFramesStayLoaded) {
  const auto display = makeDisplay();
  ASSERT_NE(display, nullptr);
  const cv::Mat3f before = shownScene(*display, scene({layer(first_, kLeft, 1, 1)}));
  for (std::uint64_t content = 2; content <= 4; ++content) {
    (void)shownScene(*display, scene({layer(first_, kLeft, 1, content)}));
  }
  std::ranges::fill(first_.mosaic, std::byte{0});
  EXPECT_EQ(
      cv::norm(shownScene(*display, scene({layer(first_, kLeft, 1, 1)})), before, cv::NORM_INF), 0);
  for (std::uint64_t content = 5; content <= 8; ++content) {
    (void)shownScene(*display, scene({layer(first_, kLeft, 1, content)}));
  }
  EXPECT_EQ(cv::norm(shownScene(*display, scene({layer(first_, kLeft, 1, 1)})), cv::NORM_INF),
            kSurround[0])
      << "it was loaded again: dark";
}

}  // namespace
