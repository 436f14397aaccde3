#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

#include "hal/emulated/rig/arc_rig.h"
#include "hal/emulated/rig/convert_pose2sim.h"
#include "hal/emulated/rig/recording_scene.h"
#include "hal/emulated/rig/stamp_code.h"
#include "hal/emulated/rig/stamp_scene.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)

std::vector<std::uint8_t> joined(const gvsp::Picture& picture) {
  std::vector<std::uint8_t> all(picture.bytes());
  picture.copyTo(all, 0);
  return all;
}

TEST(StampCode, ComesBackFromItsCells) {
  constexpr Stamp kStamp{19, 0xdeadbeef};
  const StampCells cells = encodeStamp(kStamp);
  const StampLayout layout{100, 50};
  const auto read = decodeStamp(layout, [&](double x, double y) {
    const auto column = static_cast<std::size_t>(x - layout.left_px - layout.gridLeft()) / 16;
    const auto row = static_cast<std::size_t>(y - layout.top_px - layout.gridTop()) / 16;
    return cells[row * StampLayout::kColumns + column] ? 200.0 : 20.0;
  });
  EXPECT_EQ(read, kStamp);
}

TEST(StampCode, IsNotReadFromAFlatOrDamagedPicture) {
  const StampLayout layout{0, 0};
  EXPECT_FALSE(decodeStamp(layout, [](double, double) { return 128.0; }));
  StampCells cells = encodeStamp({3, 77});
  cells[40] = !cells[40];
  EXPECT_FALSE(decodeStamp(layout, [&](double x, double y) {
    const int column = static_cast<int>(x - layout.gridLeft()) / 16;
    const int row = static_cast<int>(y - layout.gridTop()) / 16;
    return cells[static_cast<std::size_t>(row * StampLayout::kColumns + column)] ? 1.0 : 0.0;
  }));
}

TEST(StampLayout, StaysInsideAWidescreenCropOfTheMiddle) {
  const StampLayout layout = StampLayout::of(1280, 1024);
  EXPECT_GE(layout.top_px, 152 + 16);
  EXPECT_EQ(layout.left_px % 2, 0);
  EXPECT_EQ(layout.top_px % 2, 0);
  EXPECT_EQ(layout.left_px + layout.cardWidth() / 2, 640);
}

TEST(StampScene, PaintsEachCamerasTriggerIntoItsPixels) {
  for (const SizePx size : {SizePx{640, 480}, SizePx{320, 256}, SizePx{224, 160}}) {
    auto scene = StampScene::make(2, size);
    ASSERT_TRUE(scene) << scene.error();
    const auto layout =
        StampLayout::of(static_cast<int>(size.width), static_cast<int>(size.height));
    for (std::uint32_t camera = 0; camera < 2; ++camera) {
      for (std::uint64_t trigger : {1u, 2u, 3u, 4u, 5u, 123456u}) {
        const auto pixels = joined(scene->expose(camera, trigger, trigger % kFrameHistory));
        ASSERT_EQ(pixels.size(), std::size_t{size.width} * size.height);
        const auto stamp = decodeStamp(layout, [&](double x, double y) {
          return static_cast<double>(
              pixels[static_cast<std::size_t>(y) * size.width + static_cast<std::size_t>(x)]);
        });
        ASSERT_TRUE(stamp);
        EXPECT_EQ(stamp->camera, camera);
        EXPECT_EQ(stamp->trigger, trigger);
      }
    }
  }
}

TEST(StampScene, RefusesASizeThatCannotHoldTheCard) {
  const auto scene = StampScene::make(1, {208, 160});
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().find("224x160"), std::string::npos) << scene.error();
}

TEST(ArcRig, LooksAtTheTargetFromTheArc) {
  const RigModel rig = makeArcRig(20, {1280, 1024});
  ASSERT_EQ(rig.cameras.size(), 20u);
  for (const CameraModel& camera : rig.cameras) {
    std::array<double, 3> p{};
    for (std::size_t row = 0; row < 3; ++row) {
      p[row] = camera.translation_m[row];
      for (std::size_t i = 0; i < 3; ++i) p[row] += camera.rotation[row][i] * rig.target_m[i];
    }
    EXPECT_NEAR(p[2], 4.0, 0.15) << camera.name;
    const double x = camera.focal_px[0] * p[0] / p[2] + camera.centre_px[0];
    const double y = camera.focal_px[1] * p[1] / p[2] + camera.centre_px[1];
    EXPECT_NEAR(x, 639.5, 30) << camera.name;
    EXPECT_NEAR(y, 511.5, 30) << camera.name;
  }
}

void write(const test::TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
}

TEST(RecordingScene, SaysWhatIsWrongWithAFolder) {
  const test::TemporaryFolder folder;
  const auto error = [&] {
    const auto scene = RecordingScene::open(folder.path());
    return scene ? std::string("opened") : scene.error();
  };
  EXPECT_NE(error().find("rig.toml"), std::string::npos);
  write(folder, "rig.toml", "format = 0\n");
  EXPECT_NE(error().find("format = 1"), std::string::npos);
  write(folder, "rig.toml", "format = 1\n[[camera]]\nname = \"cam01\"\n");
  EXPECT_NE(error().find("rig.toml:2: "), std::string::npos) << error();
  EXPECT_NE(error().find("image_size_px"), std::string::npos);
  write(folder, "rig.toml", "format = 1\n[[camera]\n");
  EXPECT_NE(error().find("rig.toml:2"), std::string::npos) << error();
  write(folder, "rig.toml", "format = 1\n[[camera]]\nname = \"cam01\"\nimage_size_px = [64, 32]\n");
  EXPECT_NE(error().find("cam01.mp4"), std::string::npos) << error();
  write(folder, "cam01.mp4", "no video");
  EXPECT_NE(error().find("cannot be read as a video"), std::string::npos) << error();
}

TEST(RecordingScene, RefusesAMissingFolder) {
  const auto scene = RecordingScene::open("/nonexistent/scene");
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().find("/nonexistent/scene"), std::string::npos);
}

/// The smallest picture format that every reader knows would be PNM; scenes take PNG, so this
/// writes one without compression: 2 x 2 blocks of plain colour are enough.
std::string plainPicture(int width, int height, std::uint8_t red, std::uint8_t green,
                         std::uint8_t blue);

TEST(RecordingScene, PlaysPicturesInTheOrderOfTheirNamesAndStartsAgain) {
  const test::TemporaryFolder folder;
  write(folder, "rig.toml", "format = 1\n[[camera]]\nname = \"cam01\"\nimage_size_px = [4, 2]\n");
  std::filesystem::create_directory(folder.path() / "cam01");
  write(folder, "cam01/a.png", plainPicture(4, 2, 255, 0, 0));
  write(folder, "cam01/b.png", plainPicture(4, 2, 188, 188, 0));
  auto scene = RecordingScene::open(folder.path());
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_EQ(scene->pictureCount(), 2u);
  const std::vector<std::uint8_t> red = {255, 0, 255, 0, 0, 0, 0, 0};
  EXPECT_EQ(joined(scene->expose(0, 1, 0)), red);
  const auto half = joined(scene->expose(0, 2, 0));  // sRGB 188 is half the light
  EXPECT_NEAR(half[0], 128, 1);
  EXPECT_EQ(half[5], 0);  // blue
  EXPECT_EQ(joined(scene->expose(0, 3, 0)), red);
}

TEST(RecordingScene, RefusesPicturesOfAnotherSize) {
  const test::TemporaryFolder folder;
  write(folder, "rig.toml", "format = 1\n[[camera]]\nname = \"cam01\"\nimage_size_px = [8, 2]\n");
  std::filesystem::create_directory(folder.path() / "cam01");
  write(folder, "cam01/a.png", plainPicture(4, 2, 1, 2, 3));
  const auto scene = RecordingScene::open(folder.path());
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().find("4x2"), std::string::npos) << scene.error();
  EXPECT_NE(scene.error().find("8x2"), std::string::npos) << scene.error();
}

constexpr char kQualisys[] =
    R"(<calibration><cameras><camera active="1" serial="cam01">
<fov_marker bottom="1919" left="0" right="1087" top="0"/>
<transform r11="1" r12="0" r13="0" r21="0" r22="0" r23="1" r31="0" r32="-1" r33="0" x="1000" y="-2000" z="1500"/>
<intrinsic centerPointU="34784" centerPointV="61408" focalLengthU="64000" focalLengthV="64064" radialDistortion1="-0.1" radialDistortion2="0.2" radialDistortion3="0.3" tangentalDistortion1="0.01" tangentalDistortion2="0.02"/>
</camera></cameras></calibration>)";

TEST(ConvertPose2sim, ReadsAQualisysCamera) {
  const auto rig = parseQualisys(kQualisys);
  ASSERT_TRUE(rig) << rig.error();
  const CameraModel& camera = rig->cameras.at(0);
  EXPECT_EQ(camera.name, "cam01");
  EXPECT_EQ(camera.image_size, (SizePx{1088, 1920}));
  EXPECT_DOUBLE_EQ(camera.focal_px[0], 1000);
  EXPECT_DOUBLE_EQ(camera.centre_px[0], 543.5);
  EXPECT_DOUBLE_EQ(camera.distortion[2], 0.01);
  // A point 3 m beyond the camera along its axis, rig +y, lies straight ahead; up is -y.
  EXPECT_DOUBLE_EQ(camera.rotation[2][1], 1);
  EXPECT_DOUBLE_EQ(camera.rotation[1][2], -1);
  EXPECT_DOUBLE_EQ(camera.translation_m[0], -1.0);
  EXPECT_DOUBLE_EQ(camera.translation_m[2], 2.0);
}

TEST(ConvertPose2sim, NamesWhatACalibrationLacks) {
  EXPECT_FALSE(parseQualisys("<calibration/>"));
  const auto rig = parseQualisys(R"(<camera serial="cam07" x="1"></camera>)");
  ASSERT_FALSE(rig);
  EXPECT_NE(rig.error().find("cam07"), std::string::npos);
}

TEST(ConvertPose2sim, FitsACameraToVideoBetweenBars) {
  CameraModel camera;
  camera.image_size = {1088, 1920};
  camera.focal_px = {1680, 1680};
  camera.centre_px = {543.5, 959.5};
  const CameraModel fitted = letterboxed(camera, {1080, 1920});
  EXPECT_NEAR(fitted.focal_px[0], 1680 * 1080.0 / 1088, 1e-9);
  EXPECT_NEAR(fitted.centre_px[0], 539.5, 1e-9);  // the middle stays the middle
  EXPECT_NEAR(fitted.centre_px[1], 959.5, 1e-9);
}

std::string plainPicture(int width, int height, std::uint8_t red, std::uint8_t green,
                         std::uint8_t blue) {
  const auto be32 = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16),
                       static_cast<char>(v >> 8), static_cast<char>(v)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : type + data) {
      crc ^= static_cast<std::uint8_t>(c);
      for (int i = 0; i < 8; ++i) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return be32(static_cast<std::uint32_t>(data.size())) + type + data + be32(~crc);
  };
  std::string rows;
  for (int y = 0; y < height; ++y) {
    rows += '\0';
    for (int x = 0; x < width; ++x) {
      rows += {static_cast<char>(red), static_cast<char>(green), static_cast<char>(blue)};
    }
  }
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : rows) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(rows.size());
  const std::string stored = {'\x78',
                              '\x01',
                              '\x01',
                              static_cast<char>(size),
                              static_cast<char>(size >> 8),
                              static_cast<char>(~size),
                              static_cast<char>(~size >> 8)};
  const std::string header = be32(static_cast<std::uint32_t>(width)) +
                             be32(static_cast<std::uint32_t>(height)) + std::string{8, 2, 0, 0, 0};
  return std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", header) +
         chunk("IDAT", stored + rows + be32(b << 16 | a)) + chunk("IEND", "");
}

}  // namespace
