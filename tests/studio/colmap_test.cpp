/// The truth checked by a party that is not us: COLMAP gets the twenty pictures of one moment and
/// what a data sheet says of lens and sensor, and finds out by itself where the cameras are.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include "hal/emulated/studio/play.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/shown.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace emulator::studio;

constexpr double kMoment_s = 6;
constexpr double kRadius_m = 4;
constexpr double kBar = 0.005;  // of the radius
/// A 6.4 mm lens over pixels of 5.4 um, and the middle of the sensor: k1 k2 p1 p2 are COLMAP's to
/// find.
constexpr const char* kDataSheet = "1180,1180,640,512,0,0,0,0";

std::string findProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

/// Runs one of COLMAP's commands to its end.
void run(const std::string& colmap, const fs::path& folder, const std::vector<std::string>& words) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::string> command{colmap};
  command.insert(command.end(), words.begin(), words.end());
  test::ChildProcess process(command, folder / (words.front() + ".log"));
  const auto status = process.wait(std::chrono::minutes(50));
  ASSERT_EQ(status, 0) << words.front() << "\n" << process.output();
  std::printf("colmap %s: %.0f s\n", words.front().c_str(),
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

/// Centres of the pictures that were registered, in COLMAP's frame and size, by name.
std::map<std::string, Eigen::Vector3d> readCentres(const fs::path& images_txt) {
  std::map<std::string, Eigen::Vector3d> centres;
  std::ifstream file(images_txt);
  bool pose_comes = true;  // every other line has the points that a picture sees
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    if (pose_comes) {
      std::istringstream words(line);
      int image = 0;
      int camera = 0;
      double w = 1;
      Eigen::Vector3d v;
      Eigen::Vector3d t;
      std::string name;
      words >> image >> w >> v.x() >> v.y() >> v.z() >> t.x() >> t.y() >> t.z() >> camera >> name;
      if (words) centres[name] = -(Eigen::Quaterniond(w, v.x(), v.y(), v.z()).conjugate() * t);
    }
    pose_comes = !pose_comes;
  }
  return centres;
}

TEST(Colmap, FindsTheCamerasWhereTheTruthSaysTheyAre) {
  const std::string colmap = findProgram("colmap");
  if (colmap.empty()) GTEST_SKIP() << "colmap is not installed: ./dev deps studio";
  const test::TemporaryFolder folder;
  const fs::path pictures = folder / "pictures";
  fs::create_directories(pictures);
  fs::create_directories(folder / "model");

  StudioOptions options;
  const auto moment = static_cast<std::uint32_t>(std::lround(kMoment_s * kMoments_hz));
  options.only = {moment};
  options.cache = usualCache();
  {
    const auto play = Play::begin(options, [](double, const char*) {});
    ASSERT_TRUE(play) << play.error();
    for (std::uint32_t c = 0; c < options.cameras; ++c) {
      const StudioCamera& camera = (*play)->rig().cameras[c];
      cv::imwrite((pictures / (camera.model.name + ".png")).string(),
                  shownPicture(**play, c, moment));
    }
  }

  // One thread each: pictures get their numbers, and the matcher its random numbers, in an order
  // that is the same at every run.
  const std::string database = folder / "database.db";
  ASSERT_NO_FATAL_FAILURE(
      run(colmap, folder.path(),
          {"feature_extractor", "--database_path", database, "--image_path", pictures,
           "--ImageReader.camera_model", "OPENCV", "--ImageReader.camera_params", kDataSheet,
           "--SiftExtraction.use_gpu", "0", "--SiftExtraction.max_num_features", "4000",
           "--SiftExtraction.first_octave", "0", "--SiftExtraction.num_threads", "1"}));
  ASSERT_NO_FATAL_FAILURE(run(colmap, folder.path(),
                              {"exhaustive_matcher", "--database_path", database,
                               "--SiftMatching.use_gpu", "0", "--SiftMatching.num_threads", "1"}));
  // Two or three pictures cannot distinguish a bent lens from a bent scene, nor a long one from a
  // scene farther off: while pictures join one by one the lens stays as the data sheet has it. The
  // first two are of the middle, two steps apart. Left to itself the mapper likes pairs with a wide
  // base best, and the outer views share no more than a piece of wall: a plane, which two views
  // explain in two ways.
  ASSERT_NO_FATAL_FAILURE(
      run(colmap, folder.path(),
          {"mapper", "--database_path", database, "--image_path", pictures, "--output_path",
           folder / "model", "--Mapper.multiple_models", "0", "--Mapper.ba_refine_extra_params",
           "0", "--Mapper.ba_refine_focal_length", "0", "--Mapper.init_image_id1", "10",
           "--Mapper.init_image_id2", "12", "--Mapper.init_min_tri_angle", "6"}));
  const std::string model = folder / "model" / "0";
  const auto adjust = [&] {
    run(colmap, folder.path(),
        {"bundle_adjuster", "--input_path", model, "--output_path", model,
         "--BundleAdjustment.refine_principal_point", "1", "--BundleAdjustment.max_num_iterations",
         "200"});
  };
  // All twenty together determine the lens, and where in the sensor it looks. Each round finds the
  // matches again that the lens of the round before had called wrong. What is right fits to 0.2
  // pixels: as the lens gets better, a pixel is left to those who would bend it.
  ASSERT_NO_FATAL_FAILURE(adjust());
  for (const char* const error_px : {"2", "1.5", "1.2", "1", "1", "1", "1", "1", "1"}) {
    ASSERT_NO_FATAL_FAILURE(
        run(colmap, folder.path(),
            {"point_triangulator", "--clear_points", "1", "--database_path", database,
             "--image_path", pictures, "--input_path", model, "--output_path", model,
             "--Mapper.filter_max_reproj_error", error_px, "--Mapper.tri_complete_max_reproj_error",
             error_px, "--Mapper.tri_merge_max_reproj_error", error_px}));
    ASSERT_NO_FATAL_FAILURE(adjust());
  }
  ASSERT_NO_FATAL_FAILURE(run(
      colmap, folder.path(),
      {"model_converter", "--input_path", model, "--output_path", model, "--output_type", "TXT"}));

  const auto centres = readCentres(fs::path(model) / "images.txt");
  std::printf("%zu of %u views registered\n", centres.size(), options.cameras);
  ASSERT_EQ(centres.size(), options.cameras);
  Eigen::Matrix3Xd found(3, options.cameras);
  Eigen::Matrix3Xd wanted(3, options.cameras);
  const StudioRig rig = makeStudioRig(options.cameras, options.size, options.seed);
  for (std::uint32_t c = 0; c < options.cameras; ++c) {
    found.col(c) = centres.at(rig.cameras[c].model.name + ".png");
    wanted.col(c) = rig.cameras[c].centre();
  }
  // Pictures alone determine neither size nor place nor direction of the whole.
  const Eigen::Matrix4d to_rig = Eigen::umeyama(found, wanted, /*with_scaling=*/true);
  const Eigen::Matrix3Xd away =
      (to_rig.topLeftCorner<3, 3>() * found).colwise() + to_rig.topRightCorner<3, 1>() - wanted;
  const Eigen::VectorXd distance = away.colwise().norm();
  for (std::uint32_t c = 0; c < options.cameras; ++c)
    std::printf("%s: %.1f mm\n", rig.cameras[c].model.name.c_str(), 1000 * distance[c]);
  const double most = distance.maxCoeff();
  const double rms = std::sqrt(distance.squaredNorm() / options.cameras);
  std::printf(
      "camera centres differ by %.1f mm rms, %.1f mm at most: %.3f %% and %.3f %% of the "
      "radius\n",
      1000 * rms, 1000 * most, 100 * rms / kRadius_m, 100 * most / kRadius_m);
  EXPECT_LE(most, kBar * kRadius_m);
}

}  // namespace
