#include "hal/emulated/studio/people_areas.h"

#include <algorithm>
#include <cmath>

namespace emulator::studio {
namespace {

/// A point that goes further than this across the picture is drawn more than once.
constexpr double kStep_px = 2.2;
constexpr int kMostSteps = 8;

}  // namespace

std::vector<PeopleArea> peopleAreas(const StudioCamera& camera,
                                    const std::vector<ShownBody>& people, float nearest_m) {
  const cv::Rect picture(0, 0, static_cast<int>(camera.model.image_size.width),
                         static_cast<int>(camera.model.image_size.height));
  std::vector<PeopleArea> areas;
  for (const ShownBody& shown : people) {
    Eigen::AlignedBox2d box;
    bool behind = false;
    for (std::size_t i = 0; i < shown.mesh.vertices.size(); i += 5) {  // neighbours are near
      for (const Eigen::Vector3f& p :
           {shown.mesh.vertices[i].opens, shown.mesh.vertices[i].closes}) {
        const Eigen::Vector3d q = p.cast<double>();
        behind |= (camera.rotation().row(2) * (q - camera.centre()))(0) < nearest_m;
        if (!behind) box.extend(camera.project(q));
      }
    }
    if (behind) continue;
    constexpr int kMargin = 6;
    const cv::Rect rect =
        cv::Rect(cv::Point(static_cast<int>(std::clamp(box.min().x(), -1e4, 1e4)) - kMargin,
                           static_cast<int>(std::clamp(box.min().y(), -1e4, 1e4)) - kMargin),
                 cv::Point(static_cast<int>(std::clamp(box.max().x(), -1e4, 1e4)) + kMargin,
                           static_cast<int>(std::clamp(box.max().y(), -1e4, 1e4)) + kMargin)) &
        picture;
    if (!rect.empty()) areas.push_back({rect, {&shown}});
  }
  for (bool merged = true; merged;) {
    merged = false;
    for (std::size_t i = 0; i < areas.size() && !merged; ++i) {
      for (std::size_t k = i + 1; k < areas.size() && !merged; ++k) {
        if ((areas[i].rect & areas[k].rect).empty()) continue;
        areas[i].rect |= areas[k].rect;
        areas[i].people.insert(areas[i].people.end(), areas[k].people.begin(),
                               areas[k].people.end());
        areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(k));
        merged = true;
      }
    }
  }
  return areas;
}

int blurSteps(const PeopleArea& area, const StudioCamera& camera) {
  double way_px = 0;
  for (const ShownBody* shown : area.people) {
    const double distance =
        std::max(0.5, (shown->mesh.bounds.center().cast<double>() - camera.centre()).norm() - 0.5);
    way_px = std::max(way_px, shown->mesh.way_m * camera.model.focal_px[0] / distance);
  }
  return std::clamp(static_cast<int>(std::ceil(way_px / kStep_px)), 1, kMostSteps);
}

}  // namespace emulator::studio
