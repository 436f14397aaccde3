#include "hal/emulated/studio/depth_view.h"

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/covers.h"
#include "hal/emulated/studio/hall.h"
#include "hal/emulated/studio/hall_renderer.h"
#include "hal/emulated/studio/people_renderer.h"
#include "hal/emulated/studio/studio_gl.h"
#include "hal/emulated/studio/world.h"

namespace emulator::studio {

std::expected<cv::Mat, std::string> renderDepth(const StudioOptions& options, std::uint32_t camera,
                                                double second) {
  const StudioRig rig = makeStudioRig(options.cameras, options.size, options.seed);
  if (camera >= rig.cameras.size())
    return std::unexpected("there is no camera " + std::to_string(camera + 1));
  auto context = openContext();
  if (!context) return std::unexpected(context.error());
  // Distances need neither light nor paint.
  const std::vector<Surface> hall = buildHall(options.seed);
  LightMap dark{.width = 2, .height = 2, .places = {}, .texels = {}};
  dark.places.assign(hall.size(), {.x = 0, .y = 0, .width = 2, .height = 2});
  dark.texels.assign(4, Eigen::Vector4f::Zero());
  CoverPictures covers;
  covers.fill(cv::Mat(2, 2, CV_8UC4, cv::Scalar::all(255)));
  HallRenderer hall_renderer(hall, covers, covers.front(), dark);
  const Backdrop backdrop = hall_renderer.draw(rig.cameras[camera]);
  const World world(options.seed);
  const std::vector<Lamp> lamps = hallLamps(options.seed);
  const LightProbes probes;
  PeopleRenderer people(world.cast(), lamps, probes, cv::Mat(2, 2, CV_32F, cv::Scalar::all(1)));
  people.addCamera(rig.cameras[camera], backdrop.depth_m);
  people.setMoment(world.at(second, rig.cameras[camera].exposure_s));
  return people.drawDepth(0);
}

cv::Mat colourDepth(const cv::Mat& depth_m) {
  constexpr double kNear_m = 1.5;
  constexpr double kFar_m = 14;
  cv::Mat nearness;
  cv::divide(1.0, depth_m, nearness);
  const double far = 1 / kFar_m;
  const double scale = 255 / (1 / kNear_m - far);
  nearness.convertTo(nearness, CV_8U, scale, -far * scale);
  cv::Mat bgr;
  cv::applyColorMap(nearness, bgr, cv::COLORMAP_TURBO);
  return bgr;
}

}  // namespace emulator::studio
