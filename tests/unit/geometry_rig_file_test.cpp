#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/geometry/rig_file.h"

namespace {

using appliance::parseRig;
using testing::AllOf;
using testing::HasSubstr;
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
  EXPECT_EQ(first.gain_rgb, (std::array{1.5F, 1.0F, 2.0F}));
  EXPECT_EQ(rig->cameras[1].gain_rgb, (std::array{1.0F, 1.0F, 1.0F}));
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

TEST(RigFile, RefusesAnotherFormatBeforeAnythingElse) {
  EXPECT_EQ(errorOf("shape = \"ring\"\nformat = 2\n"),
            "rig.toml:2: format 2 is not known here, only format 1; update the appliance or "
            "convert the file");
  EXPECT_EQ(errorOf("name = \"arc\"\n"), "rig.toml:1: the key \"format\" is missing; add it");
  EXPECT_EQ(errorOf("format = \"1\"\n"), "rig.toml:1: format must be a whole number, not text");
}

TEST(RigFile, RefusesUnknownKeysAndSuggestsTheClosest) {
  EXPECT_EQ(errorOf("format = 1\ntaget_m = [0, 0, 1]\n" + camera("cam01")),
            "rig.toml:2: unknown key \"taget_m\"; did you mean \"target_m\"?");
  EXPECT_EQ(errorWith("centre_px", "center_px = [639.5, 511.5]"),
            "rig.toml:15: camera \"cam02\": unknown key \"center_px\"; did you mean "
            "\"centre_px\"?");
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
