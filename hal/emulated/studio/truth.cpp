#include "hal/emulated/studio/truth.h"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/world.h"

namespace emulator::studio {
namespace {

using Json = nlohmann::ordered_json;

/// To a tenth of a millimetre.
Json point(const Eigen::Vector3d& p) {
  const auto rounded = [](double v) { return std::round(v * 1e4) / 1e4; };
  return Json::array({rounded(p.x()), rounded(p.y()), rounded(p.z())});
}

Json describe(const StudioCamera& camera) {
  const CameraModel& m = camera.model;
  return {{"name", m.name},
          {"image_size_px", {m.image_size.width, m.image_size.height}},
          {"focal_px", m.focal_px},
          {"centre_px", m.centre_px},
          {"distortion", m.distortion},
          {"rotation_cam_rig", m.rotation},
          {"translation_cam_rig_m", m.translation_m},
          {"response_rgb", camera.response},
          {"vignetting", camera.vignetting},
          {"exposure_s", camera.exposure_s},
          {"read_noise_dn", camera.read_noise_dn},
          {"electrons_per_dn", camera.electrons_per_dn}};
}

std::expected<void, std::string> done(std::ofstream& file, const std::filesystem::path& path) {
  file.flush();
  if (!file) return std::unexpected("cannot write " + path.string());
  return {};
}

}  // namespace

std::expected<void, std::string> writeTruth(const std::filesystem::path& folder,
                                            const StudioOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const World world(options.seed, World::Clothes::kNone);
  Json truth = {{"format", 1},
                {"seed", options.seed},
                {"moments_hz", kMoments_hz},
                {"cameras", Json::array()},
                {"throws", Json::array()}};
  for (const StudioCamera& camera :
       makeStudioRig(options.cameras, options.size, options.seed).cameras)
    truth["cameras"].push_back(describe(camera));
  for (const ThrowTruth& t : world.athlete().throws()) {
    truth["throws"].push_back({{"action", name(t.kind)},
                               {"left_handed", t.left_handed},
                               {"wind_up_s", t.wind_up},
                               {"stride_s", t.stride},
                               {"foot_contact_s", t.foot_contact},
                               {"max_external_rotation_s", t.max_external_rotation},
                               {"release_s", t.release},
                               {"max_internal_rotation_s", t.max_internal_rotation},
                               {"end_s", t.end},
                               {"speed", t.speed},
                               {"height", t.height}});
  }
  {
    std::ofstream file(folder / "truth.json");
    file << truth.dump(1) << "\n";
    if (auto written = done(file, folder / "truth.json"); !written) return written;
  }
  std::ofstream file(folder / "moments.jsonl");
  const auto count = std::lround(options.play_s * kMoments_hz);
  for (long moment = 0; moment < count; ++moment) {
    const double second = static_cast<double>(moment) / kMoments_hz;
    Json line = {{"moment", moment}, {"second", second}};
    for (std::size_t i = 0; i < world.peopleCount(); ++i) {
      const PoseAt pose = world.person(i).at(second);
      Json joints = Json::array();
      for (const Eigen::Vector3d& joint : pose.joints) joints.push_back(point(joint));
      if (i == 0) {
        line["phase"] = name(pose.phase);
        constexpr const char* kStates[] = {"none", "held", "flying"};
        line["ball"] = {{"state", kStates[static_cast<std::size_t>(pose.ball_state)]},
                        {"centre_m", point(pose.ball)},
                        {"radius_m", pose.ball_radius_m}};
      }
      line["people"].push_back(std::move(joints));
    }
    file << line.dump() << "\n";
  }
  return done(file, folder / "moments.jsonl");
}

std::expected<void, std::string> writeRounds(const std::filesystem::path& folder,
                                             std::span<const StudioScene::Round> rounds) {
  std::ofstream file(folder / "rounds.csv");
  file << "first_trigger,moments\n";
  for (const StudioScene::Round& round : rounds)
    file << round.first_trigger << ',' << round.moments << '\n';
  return done(file, folder / "rounds.csv");
}

}  // namespace emulator::studio
