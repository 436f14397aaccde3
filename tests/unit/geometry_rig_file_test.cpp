#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/geometry/rig_file.h"

namespace {

using appliance::parseRig;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kHead = "format = 1\nname = \"arc\"\ntarget_m = [0.0, 0.0, 1.0]\n";

/// A sound camera 4 m in front of the target, looking along +Y; one of its lines replaced.
std::string camera(const std::string& name, const std::string& key = "",
                   const std::string& line = "") {
  std::string out = "[[camera]]\n";
  const auto add = [&](const char* of, const std::string& usual) {
    if (key == of) {
      if (!line.empty()) out += line + "\n";
    } else {
      out += std::string(of) + " = " + usual + "\n";
    }
  };
  add("name", "\"" + name + "\"");
  add("image_size_px", "[1280, 1024]");
  add("focal_px", "[1180.0, 1190.0]");
  add("centre_px", "[639.5, 511.5]");
  add("distortion", "[0.1, -0.02, 0.001, -0.001, 0.01]");
  add("T_cam_rig", "[[1, 0, 0, 0], [0, 0, -1, 1.0], [0, 1, 0, 4.0]]");
  return out;
}

std::string errorOf(const std::string& text) {
  const auto rig = parseRig(text, "rig.toml");
  return rig ? "accepted" : rig.error();
}

/// The message for a rig whose second camera has @p line in place of @p key; its header is line
/// 11, name 12, image_size_px 13, focal_px 14, centre_px 15, distortion 16, T_cam_rig 17.
std::string errorWith(const std::string& key, const std::string& line) {
  const std::string error = errorOf(kHead + camera("cam01") + camera("cam02", key, line));
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  return error;
}

TEST(RigFile, GivesEveryCameraInFileOrderWithItsCalibration) {
  const auto rig =
      parseRig(kHead + camera("cam01") + "gain_rgb = [1.5, 1, 2]\n" + camera("cam02"), "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error();
  EXPECT_EQ(rig->name, "arc");
  EXPECT_EQ(rig->target_m, Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(rig->cameras.size(), 2u);
  const appliance::RigCamera& first = rig->cameras[0];
  EXPECT_EQ(first.name, "cam01");
  EXPECT_EQ(first.width_px, 1280u);
  EXPECT_EQ(first.height_px, 1024u);
  EXPECT_EQ(first.lens.fx_px, 1180);
  EXPECT_EQ(first.lens.fy_px, 1190);
  EXPECT_EQ(first.lens.cx_px, 639.5);
  EXPECT_EQ(first.lens.cy_px, 511.5);
  EXPECT_EQ(first.lens.distortion, (std::array{0.1, -0.02, 0.001, -0.001, 0.01}));
  EXPECT_GT(first.lens.max_radius, 0.6);
  EXPECT_TRUE(first.centre_m().isApprox(Eigen::Vector3d(0, -4, 1)));
  EXPECT_EQ(first.colour.gain_rgb, (std::array{1.5F, 1.0F, 2.0F}));
  EXPECT_EQ(rig->cameras[1].colour.gain_rgb, (std::array{1.0F, 1.0F, 1.0F}));
}

TEST(RigFile, TakesTheMeansAsReferencesUnlessTheyAreStated) {
  const std::string cameras =
      camera("near") +
      camera("far", "T_cam_rig", "T_cam_rig = [[1, 0, 0, 0], [0, 0, -1, 1.0], [0, 1, 0, 6.0]]");
  const auto means = parseRig(kHead + cameras, "rig.toml");
  ASSERT_TRUE(means.has_value()) << means.error();
  EXPECT_DOUBLE_EQ(means->reference_focal_px, 1185);
  EXPECT_DOUBLE_EQ(means->reference_distance_m, 5);
  EXPECT_DOUBLE_EQ(means->reference_height_px, 1024);

  const auto stated = parseRig(
      kHead + std::string("reference_focal_px = 1000\nreference_distance_m = 4.5\n") + cameras,
      "rig.toml");
  ASSERT_TRUE(stated.has_value()) << stated.error();
  EXPECT_DOUBLE_EQ(stated->reference_focal_px, 1000);
  EXPECT_DOUBLE_EQ(stated->reference_distance_m, 4.5);
}

TEST(RigFile, SaysThatTheFileIsMissing) {
  const auto rig = appliance::loadRig("/nonexistent/rig.toml");
  ASSERT_FALSE(rig.has_value());
  EXPECT_THAT(rig.error(), StartsWith("/nonexistent/rig.toml: cannot be opened"));
}

TEST(RigFile, NamesTheLineOfASyntaxError) {
  EXPECT_THAT(errorOf("format = 1\nname = arc\n"), StartsWith("rig.toml:2: not valid TOML"));
}

/// The warnings of a rig that is accepted.
std::vector<std::string> warningsOf(const std::string& text) {
  const auto rig = parseRig(text, "rig.toml");
  EXPECT_TRUE(rig.has_value()) << rig.error();
  return rig ? rig->warnings : std::vector<std::string>{};
}

TEST(RigFile, ReadsANewerFormatAsFarAsItKnowsItAndSaysSo) {
  const std::string head = "format = 3\nname = \"arc\"\ntarget_m = [0.0, 0.0, 1.0]\n";
  EXPECT_THAT(warningsOf(head + "mirror = true\n" + camera("cam01")),
              ElementsAre("rig.toml:1: format 3 is newer than this version's 2: what it adds is "
                          "ignored; update the appliance",
                          "rig.toml:4: unknown key \"mirror\"; it is ignored; another version may "
                          "know it"));
}

TEST(RigFile, RefusesAFileThatStatesNoFormat) {
  EXPECT_EQ(errorOf("name = \"arc\"\n"), "rig.toml:1: the key \"format\" is missing; add it");
  EXPECT_EQ(errorOf("format = \"1\"\n"), "rig.toml:1: format must be a whole number, not text");
  EXPECT_THAT(errorOf("format = 0\n"), StartsWith("rig.toml:1: format must be from 1 to"));
}

TEST(RigFile, IgnoresUnknownKeysAndNamesLineAndClosestKey) {
  EXPECT_THAT(warningsOf(kHead + camera("cam01") + "blak_level = 4\n"),
              ElementsAre("rig.toml:11: camera \"cam01\": unknown key \"blak_level\"; did you mean "
                          "\"black_level\"?"));
  EXPECT_THAT(warningsOf(kHead + camera("cam01")), IsEmpty());
}

TEST(RigFile, SaysWhatIsMissingWhereARequiredKeyIsMisspelt) {
  EXPECT_EQ(errorOf("format = 1\ntaget_m = [0, 0, 1]\n" + camera("cam01")),
            "rig.toml:1: the key \"target_m\" is missing; add it");
}

TEST(RigFile, ChangesNoColourWithoutTheKeysOfFormat2) {
  const auto rig = parseRig(kHead + camera("cam01"), "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error();
  EXPECT_EQ(rig->cameras[0].colour, hal::ColourModel{});
  EXPECT_EQ(rig->cameras[0].pixel_format, hal::PixelFormat::kBayerRG8);
}

constexpr const char* kHead2 = "format = 2\nname = \"arc\"\ntarget_m = [0.0, 0.0, 1.0]\n";

TEST(RigFile, GivesEveryCameraItsColourAndPixelFormat) {
  const auto rig = parseRig(kHead2 + camera("cam01") +
                                "pixel_format = \"BayerGB8\"\nblack_level = 4.5\n"
                                "vignetting = [-0.3, 0.05]\n"
                                "colour_matrix = [[1.5, -0.3, -0.2], [-0.2, 1.4, -0.2], "
                                "[0, -0.5, 1.5]]\n" +
                                camera("cam02"),
                            "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error();
  EXPECT_THAT(rig->warnings, IsEmpty());
  const appliance::RigCamera& first = rig->cameras[0];
  EXPECT_EQ(first.pixel_format, hal::PixelFormat::kBayerGB8);
  EXPECT_EQ(first.colour.black_level, 4.5F);
  EXPECT_EQ(first.colour.vignetting, (std::array{-0.3F, 0.05F, 0.0F}));
  EXPECT_EQ(first.colour.matrix,
            (std::array{1.5F, -0.3F, -0.2F, -0.2F, 1.4F, -0.2F, 0.0F, -0.5F, 1.5F}));
  EXPECT_EQ(rig->cameras[1].colour, hal::ColourModel{});
  const auto grey = parseRig(kHead2 + camera("cam01"), "rig.toml", hal::PixelFormat::kMono8);
  ASSERT_TRUE(grey.has_value()) << grey.error();
  EXPECT_EQ(grey->cameras[0].pixel_format, hal::PixelFormat::kMono8);
}

TEST(RigFile, RefusesWrongColoursAndNamesTheLine) {
  const auto with = [](const std::string& line) {
    return errorOf(kHead2 + camera("cam01") + line + "\n");
  };
  EXPECT_EQ(with("pixel_format = \"Bayer\""),
            "rig.toml:11: camera \"cam01\": pixel_format must be one of BayerRG8, BayerGB8, "
            "BayerGR8, BayerBG8, Mono8, not \"Bayer\"");
  EXPECT_THAT(with("black_level = 200"), HasSubstr("black_level must be from 0 to 127"));
  EXPECT_THAT(with("colour_matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 99]]"),
              HasSubstr("colour_matrix[2][2] must be from -16 to 16, not 99"));
  EXPECT_THAT(with("vignetting = [-1.5]"), HasSubstr("vignetting leaves less than 5 %"));
  EXPECT_THAT(with("vignetting = [0, 0, 0, 0]"), HasSubstr("up to 3 numbers"));
}

TEST(RigFile, HasACylinderAboutTheTargetAsTheUsualTargetVolume) {
  const auto rig = parseRig(kHead + camera("cam01"), "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error();
  EXPECT_EQ(rig->target_volume.shape, appliance::TargetVolume::Shape::kCylinder);
  EXPECT_EQ(rig->target_volume.centre_m, std::nullopt);
  EXPECT_EQ(rig->target_volume.half_size_m, Eigen::Vector3d(0.1, 0.1, 0.1));
}

TEST(RigFile, ReadsATargetVolume) {
  const std::string cylinder = "[target_volume]\nradius_m = 0.5\nheight_m = 1\n";
  const auto round = parseRig(kHead2 + cylinder + camera("cam01"), "rig.toml");
  ASSERT_TRUE(round.has_value()) << round.error();
  EXPECT_EQ(round->target_volume.half_size_m, Eigen::Vector3d(0.5, 0.5, 0.5));
  const std::string box = "[target_volume]\ncentre_m = [1, 0, 1]\nsize_m = [1, 4, 0.5]\n";
  const auto square = parseRig(kHead2 + box + camera("cam01"), "rig.toml");
  ASSERT_TRUE(square.has_value()) << square.error();
  EXPECT_EQ(square->target_volume.shape, appliance::TargetVolume::Shape::kBox);
  EXPECT_EQ(square->target_volume.centre_m, Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(square->target_volume.half_size_m, Eigen::Vector3d(0.5, 2, 0.25));
  EXPECT_THAT(errorOf(kHead2 + box + "radius_m = 1\n" + camera("cam01")),
              HasSubstr("rig.toml:6: [target_volume]: size_m makes a box"));
  EXPECT_THAT(errorOf(kHead2 + std::string("[target_volume]\nradius_m = -1\n") + camera("cam01")),
              HasSubstr("radius_m must be from 0 to 100 m"));
}

TEST(RigFile, RefusesMissingKeysAndSaysOfWhichCamera) {
  for (const char* key : {"image_size_px", "focal_px", "centre_px", "distortion", "T_cam_rig"}) {
    EXPECT_EQ(errorWith(key, ""), "rig.toml:11: camera \"cam02\": the key \"" + std::string(key) +
                                      "\" is missing; add it");
  }
  EXPECT_EQ(errorWith("name", ""), "rig.toml:11: camera 2: the key \"name\" is missing; add it");
  EXPECT_THAT(errorOf("format = 1\n" + camera("cam01")), HasSubstr("\"target_m\" is missing"));
}

TEST(RigFile, RefusesArraysOfAnotherLength) {
  EXPECT_EQ(errorWith("distortion", "distortion = [0, 0, 0, 0]"),
            "rig.toml:16: camera \"cam02\": distortion must be an array of 5 numbers, not an "
            "array of 4");
  EXPECT_THAT(errorWith("focal_px", "focal_px = 1180.0"),
              HasSubstr("rig.toml:14: camera \"cam02\": focal_px must be an array of 2 numbers"));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]"),
              HasSubstr("T_cam_rig[0] must be an array of 4 numbers"));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1, 0, 0, 0]]"),
              HasSubstr("T_cam_rig must be an array of 3 rows of 4 numbers"));
}

TEST(RigFile, RefusesNumbersThatAreNotFinite) {
  EXPECT_THAT(errorWith("distortion", "distortion = [nan, 0, 0, 0, 0]"),
              HasSubstr("distortion[0] must be a finite number"));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1,0,0,inf],[0,0,-1,1],[0,1,0,4]]"),
              HasSubstr("must be a finite number"));
}

TEST(RigFile, RefusesImpossibleFocalLengthsSizesAndGains) {
  EXPECT_THAT(errorWith("focal_px", "focal_px = [0, 1180]"),
              StartsWith("rig.toml:14: camera \"cam02\": focal_px[0] must be from 1 to"));
  EXPECT_THAT(errorWith("focal_px", "focal_px = [1180, -1180]"),
              HasSubstr("focal_px[1] must be from 1 to"));
  EXPECT_THAT(
      errorWith("image_size_px", "image_size_px = [0, 1024]"),
      StartsWith("rig.toml:13: camera \"cam02\": image_size_px[0] must be from 1 to 16384"));
  EXPECT_THAT(errorWith("image_size_px", "image_size_px = [1280, 100000]"),
              HasSubstr("image_size_px[1] must be from 1 to 16384 px, not 100000"));
  EXPECT_THAT(errorWith("image_size_px", "image_size_px = [1280.5, 1024]"),
              HasSubstr("image_size_px must be two whole numbers"));
  EXPECT_THAT(errorWith("centre_px", "centre_px = [639.5, 5000]"),
              HasSubstr("centre_px[1] must be from -1280 to 2560 px"));
  EXPECT_THAT(errorOf(kHead + camera("cam01") + "gain_rgb = [1, 0, 1]\n"),
              HasSubstr("gain_rgb[1] must be from 0.01 to 100"));
}

TEST(RigFile, RefusesAPoseWhoseRotationIsNone) {
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1, 0.01, 0, 0], [0, 0, -1, 1], [0, 1, 0, 4]]"),
              AllOf(StartsWith("rig.toml:17: camera \"cam02\": "), HasSubstr("not a rotation")));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[-1, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 4]]"),
              HasSubstr("mirrors (determinant -1)"));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 4]]"),
              HasSubstr("not a rotation"));
}

TEST(RigFile, AsksForMetresWhereMillimetresWereWritten) {
  EXPECT_THAT(
      errorWith("T_cam_rig", "T_cam_rig = [[1, 0, 0, 0], [0, 0, -1, 1000], [0, 1, 0, 4000]]"),
      HasSubstr("is it in millimetres?"));
}

TEST(RigFile, AcceptsARotationRoundedToSixDecimals) {
  EXPECT_EQ(errorWith("T_cam_rig",
                      "T_cam_rig = [[0.866025, -0.5, 0, 0], [0, 0, -1, 1], [0.5, 0.866025, 0, 4]]"),
            "accepted");
}

TEST(RigFile, MakesARoundedRotationExact) {
  const auto rig = parseRig(
      kHead + camera("cam01", "T_cam_rig",
                     "T_cam_rig = [[0.86603, -0.5, 0, 0], [0, 0, -1, 1], [0.5, 0.86603, 0, 4]]"),
      "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error();
  const Eigen::Matrix3d& R = rig->cameras[0].R_cam_rig;
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(R(0, 0), std::sqrt(0.75), 1e-5);
}

TEST(RigFile, RefusesADistortionThatFoldsThePicture) {
  EXPECT_THAT(errorWith("distortion", "distortion = [-80, 0, 0, 0, 0]"),
              StartsWith("rig.toml:16: camera \"cam02\": distortion folds the picture"));
}

TEST(RigFile, RefusesTwoCamerasOfOneNameAndNamesTheLine) {
  EXPECT_EQ(errorWith("name", "name = \"cam01\""),
            "rig.toml:12: camera \"cam01\": the name is used twice; names must differ");
  EXPECT_THAT(errorWith("name", "name = \"\""), HasSubstr("name is empty"));
}

TEST(RigFile, RefusesATargetInOrBehindACamera) {
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, -4]]"),
              AllOf(StartsWith("rig.toml:17: camera \"cam02\": "), HasSubstr("behind the camera")));
  EXPECT_THAT(errorWith("T_cam_rig", "T_cam_rig = [[1, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 0.05]]"),
              HasSubstr("0.05 m from the camera itself"));
}

TEST(RigFile, RefusesARigWithoutCamerasOrWithTooMany) {
  EXPECT_THAT(errorOf(kHead), StartsWith("rig.toml:1: no camera;"));
  EXPECT_THAT(errorOf(kHead + std::string("camera = 3\n")), HasSubstr("[[camera]]"));
  std::string text = kHead;
  for (int i = 0; i < 64; ++i) text += camera("cam" + std::to_string(i));
  EXPECT_EQ(errorOf(text), "accepted");
  EXPECT_THAT(errorOf(text + camera("one more")), HasSubstr("65 cameras, at most 64"));
}

TEST(RigFile, RefusesReferencesThatNoRigHas) {
  for (const char* line : {"reference_focal_px = 0\n", "reference_focal_px = -3\n",
                           "reference_distance_m = 0\n", "reference_distance_m = inf\n"}) {
    EXPECT_THAT(errorOf(kHead + std::string(line) + camera("cam01")),
                StartsWith("rig.toml:4: reference_"));
  }
}

}  // namespace
