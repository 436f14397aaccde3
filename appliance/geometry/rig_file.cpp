#include "appliance/geometry/rig_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "appliance/config/toml_reader.h"
#include "appliance/geometry/homography.h"
#include "appliance/geometry/lens.h"
#include "hal/pixel_format.h"

namespace appliance {
namespace {

/// Older formats lack keys and are read; a newer one is read as far as its keys are known.
constexpr std::int64_t kNewestFormat = 2;
/// Rows written with six decimals are orthonormal to about 1e-6; a typing error is far above.
constexpr double kRotationTolerance = 1e-4;
constexpr std::int64_t kLargestSide_px = 16384;
constexpr double kLargestFocal_px = 1e6;
/// The largest distance of a rig in metres; a larger number is probably in millimetres.
constexpr double kLargestLength_m = 1000;
constexpr NumberRange kLength = {-kLargestLength_m, kLargestLength_m, "m"};

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g m", value);
  return text.data();
}

/// A focal length of the rig file: strictly positive.
constexpr NumberRange kFocal = {1, kLargestFocal_px, "px"};

/// Half the range: more is no pedestal but a wrong unit.
constexpr NumberRange kBlackLevel = {0, 127, "(8-bit codes)"};
constexpr NumberRange kMatrixElement = {-16, 16, ""};
constexpr std::size_t kMostVignettingTerms = 3;
// Darker than the first, noise is all that a gain would show; no lens is brighter at its edge.
constexpr double kDarkestFallOff = 0.05;
constexpr double kBrightestFallOff = 2;

// The working point itself with a hand's breadth around it: docs/decisions/0020-cover-zoom.md.
constexpr double kUsualRadius_m = 0.1;
constexpr double kUsualHeight_m = 0.2;
constexpr NumberRange kVolumeLength = {0, 100, "m"};

void readPose(const TomlTable& table, RigCamera& camera) {
  const std::vector<double> rows = table.matrix("T_cam_rig", 3, 4);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> T(rows.data());
  camera.R_cam_rig = T.leftCols<3>();
  camera.t_cam_rig_m = T.col(3);
  const Eigen::Matrix3d& R = camera.R_cam_rig;
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <=
        kRotationTolerance)) {
    table.fail("T_cam_rig",
               "the left 3x3 of T_cam_rig is not a rotation (its rows are not unit vectors at "
               "right angles); calibrate again or correct the numbers");
  } else if (R.determinant() < 0) {
    table.fail("T_cam_rig",
               "the left 3x3 of T_cam_rig mirrors (determinant -1); camera axes are x right, "
               "y down, z forward");
  } else if (!(camera.t_cam_rig_m.cwiseAbs().maxCoeff() <= kLargestLength_m)) {
    table.fail("T_cam_rig",
               "the last column of T_cam_rig is in metres and may not exceed 1000 m; "
               "is it in millimetres?");
  }
  // Rounding in the file would otherwise tilt every product of R with its transpose.
  camera.R_cam_rig = Eigen::Quaterniond(camera.R_cam_rig).normalized().toRotationMatrix();
}

float narrow(double value) {
  return static_cast<float>(value);
}

void readColour(const TomlTable& table, hal::ColourModel& colour) {
  if (table.has("gain_rgb"))
    std::ranges::transform(table.numbers<3>("gain_rgb", {0.01, 100, ""}), colour.gain_rgb.begin(),
                           narrow);
  colour.black_level = narrow(table.numberOr("black_level", 0, kBlackLevel));
  if (table.has("colour_matrix"))
    std::ranges::transform(table.matrix("colour_matrix", 3, 3, kMatrixElement),
                           colour.matrix.begin(), narrow);
  const auto terms = table.numberListOr("vignetting", {}, {-100, 100, ""});
  if (terms.size() > kMostVignettingTerms) {
    table.fail("vignetting", "vignetting must be up to " + std::to_string(kMostVignettingTerms) +
                                 " numbers, for r^2, r^4 and r^6, not " +
                                 std::to_string(terms.size()));
    return;
  }
  std::ranges::transform(terms, colour.vignetting.begin(), narrow);
}

/// Whether the correction leaves enough light everywhere in the picture.
void checkVignetting(const TomlTable& table, const RigCamera& camera) {
  const hal::Lens& lens = camera.lens;
  const double far_x = std::max(lens.cx_px, camera.width_px - 1 - lens.cx_px);
  const double far_y = std::max(lens.cy_px, camera.height_px - 1 - lens.cy_px);
  const double half_diagonal = std::hypot(camera.width_px, camera.height_px) / 2;
  const double farthest2 = (far_x * far_x + far_y * far_y) / (half_diagonal * half_diagonal);
  constexpr int kSteps = 256;
  for (int step = 0; step <= kSteps; ++step) {
    const double r2 = farthest2 * step / kSteps;
    const auto& v = camera.colour.vignetting;
    const double fall_off = 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2]));
    if (fall_off >= kDarkestFallOff && fall_off <= kBrightestFallOff) continue;
    table.fail("vignetting",
               "vignetting leaves less than 5 % or more than 200 % of the light in a part of the "
               "picture; r is 1 at half the picture's diagonal");
    return;
  }
}

hal::PixelFormat readPixelFormat(const TomlTable& table, hal::PixelFormat usual) {
  const std::string name = table.textOr("pixel_format", hal::genicamName(usual));
  std::string known;
  for (const hal::PixelFormat format : hal::kPixelFormats) {
    if (name == hal::genicamName(format)) return format;
    known += std::string(known.empty() ? "" : ", ") + hal::genicamName(format);
  }
  table.fail("pixel_format", "pixel_format must be one of " + known + ", not \"" + name + "\"");
  return usual;
}

RigCamera readCamera(TomlTable& table, std::size_t number, hal::PixelFormat usual_format) {
  RigCamera camera;
  table.setLabel("camera " + std::to_string(number));
  camera.name = table.textOr("name", "");
  if (!camera.name.empty()) table.setLabel("camera \"" + camera.name + "\"");
  table.warnUnknownKeys({"name", "image_size_px", "focal_px", "centre_px", "distortion",
                         "T_cam_rig", "gain_rgb", "pixel_format", "black_level", "colour_matrix",
                         "vignetting"});
  if (table.text("name").empty()) table.fail("name", "name is empty; give the camera one");

  const auto size_px = table.numbers<2>("image_size_px", {1, kLargestSide_px, "px"});
  if (size_px[0] != std::floor(size_px[0]) || size_px[1] != std::floor(size_px[1]))
    table.fail("image_size_px", "image_size_px must be two whole numbers: width, height");
  camera.width_px = static_cast<std::uint32_t>(size_px[0]);
  camera.height_px = static_cast<std::uint32_t>(size_px[1]);

  hal::Lens& lens = camera.lens;
  const auto focal_px = table.numbers<2>("focal_px", kFocal);
  lens.fx_px = focal_px[0];
  lens.fy_px = focal_px[1];
  // The optical axis may leave a cropped picture, but not by more than its size.
  const double largest_side_px = std::max(size_px[0], size_px[1]);
  const auto centre_px =
      table.numbers<2>("centre_px", {-largest_side_px, 2 * largest_side_px, "px"});
  lens.cx_px = centre_px[0];
  lens.cy_px = centre_px[1];
  lens.distortion = table.numbers<5>("distortion", {-1000, 1000, ""});
  readPose(table, camera);
  readColour(table, camera.colour);
  camera.pixel_format = readPixelFormat(table, usual_format);
  return camera;
}

/// Sets the radius up to which the lens model holds, and refuses one that hardly holds at all.
void checkLens(const TomlTable& table, RigCamera& camera) {
  hal::Lens& lens = camera.lens;
  lens.max_radius = maxRadius(lens, camera.width_px, camera.height_px);
  const double half_diagonal =
      std::hypot(camera.width_px / lens.fx_px, camera.height_px / lens.fy_px) / 2;
  if (lens.max_radius < half_diagonal / 4)
    table.fail("distortion",
               "distortion folds the picture near its centre; check the order k1 k2 p1 p2 k3 or "
               "calibrate again");
}

/// Whether the camera can show the rig's working point at all.
void checkTarget(const TomlTable& table, const RigCamera& camera, const Eigen::Vector3d& target_m) {
  const Eigen::Vector3d target_cam_m = camera.R_cam_rig * target_m + camera.t_cam_rig_m;
  const double distance_m = target_cam_m.norm();
  if (distance_m < kNearestTarget_m) {
    table.fail("T_cam_rig", "target_m lies " + metres(distance_m) +
                                " from the camera itself; correct target_m or T_cam_rig (x_cam = "
                                "R x_rig + t, in metres)");
  } else if (target_cam_m.z() <= kSmallestAxisCosine * distance_m) {
    table.fail("T_cam_rig",
               "target_m lies behind the camera; correct target_m or T_cam_rig (x_cam = R x_rig + "
               "t: is the inverse written down?)");
  }
}

TargetVolume readTargetVolume(const TomlTable& table) {
  table.warnUnknownKeys({"centre_m", "radius_m", "height_m", "size_m"});
  TargetVolume volume;
  if (table.has("centre_m")) {
    const auto centre_m = table.numbers<3>("centre_m", kLength);
    volume.centre_m = Eigen::Vector3d(centre_m.data());
  }
  if (table.has("size_m")) {
    if (table.has("radius_m") || table.has("height_m"))
      table.fail("size_m",
                 "size_m makes a box, radius_m and height_m a cylinder; keep one of them");
    const auto size_m = table.numbers<3>("size_m", kVolumeLength);
    volume.shape = TargetVolume::Shape::kBox;
    volume.half_size_m = Eigen::Map<const Eigen::Vector3d>(size_m.data()) / 2;
    return volume;
  }
  const double radius_m = table.numberOr("radius_m", kUsualRadius_m, kVolumeLength);
  const double height_m = table.numberOr("height_m", kUsualHeight_m, kVolumeLength);
  volume.half_size_m = {radius_m, radius_m, height_m / 2};
  return volume;
}

/// A newer file still starts the box: what it adds is ignored and named.
void checkFormat(const TomlTable& root) {
  const std::int64_t format = root.integer("format", {1, std::numeric_limits<int>::max(), ""});
  if (format > kNewestFormat)
    root.warn("format", "format " + std::to_string(format) + " is newer than this version's " +
                            std::to_string(kNewestFormat) +
                            ": what it adds is ignored; update the appliance");
}

std::expected<Rig, std::string> readRig(const TomlFile& file, hal::PixelFormat usual_format) {
  const TomlTable root = file.root();
  checkFormat(root);
  root.warnUnknownKeys({"format", "name", "target_m", "target_volume", "reference_focal_px",
                        "reference_distance_m", "camera"});

  Rig rig;
  rig.name = root.textOr("name", "");
  const auto target_m = root.numbers<3>("target_m", kLength);
  rig.target_m = Eigen::Map<const Eigen::Vector3d>(target_m.data());
  rig.target_volume = readTargetVolume(root.table("target_volume"));
  rig.reference_focal_px =
      root.has("reference_focal_px") ? root.number("reference_focal_px", kFocal) : 0;
  rig.reference_distance_m =
      root.has("reference_distance_m")
          ? root.number("reference_distance_m", {kNearestTarget_m, kLargestLength_m, "m"})
          : 0;

  std::vector<TomlTable> tables = root.tables("camera");
  if (tables.empty()) root.fail("camera", "no camera; write one [[camera]] table for each");
  if (tables.size() > kMaxCameras)
    root.fail("camera", std::to_string(tables.size()) + " cameras, at most " +
                            std::to_string(kMaxCameras) + " are possible; remove some");
  for (TomlTable& table : tables) {
    if (file.fault()) break;
    RigCamera camera = readCamera(table, rig.cameras.size() + 1, usual_format);
    if (file.fault()) break;  // the checks below need sound numbers
    if (std::ranges::find(rig.cameras, camera.name, &RigCamera::name) != rig.cameras.end())
      table.fail("name", "the name is used twice; names must differ");
    checkTarget(table, camera, rig.target_m);
    checkLens(table, camera);
    checkVignetting(table, camera);
    rig.cameras.push_back(std::move(camera));
  }
  if (file.fault()) return std::unexpected(*file.fault());
  fillReferences(rig);
  rig.warnings = file.warnings();
  return rig;
}

}  // namespace

std::expected<Rig, std::string> loadRig(const std::string& path, hal::PixelFormat usual_format) {
  const auto file = TomlFile::load(path);
  if (!file) return std::unexpected(file.error());
  return readRig(*file, usual_format);
}

std::expected<Rig, std::string> parseRig(std::string_view text, std::string name,
                                         hal::PixelFormat usual_format) {
  const auto file = TomlFile::parse(text, std::move(name));
  if (!file) return std::unexpected(file.error());
  return readRig(*file, usual_format);
}

}  // namespace appliance
