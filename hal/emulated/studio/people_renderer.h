#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/athlete/body.h"
#include "hal/emulated/studio/backdrop.h"
#include "hal/emulated/studio/body_mesh.h"
#include "hal/emulated/studio/floor_shade.h"
#include "hal/emulated/studio/lamps.h"
#include "hal/emulated/studio/light_bake.h"
#include "hal/emulated/studio/moment.h"
#include "hal/emulated/studio/people_areas.h"
#include "hal/emulated/studio/studio_gl.h"

namespace emulator::studio {

/// One of those who may be in the picture: the surface to be seen, and a rougher one for shadows.
struct CastMember {
  Body surface;
  Body shadow;
};

/// A rectangle of one camera's picture with the people in it.
struct PeoplePicture {
  cv::Rect area;
  cv::Mat roots;  ///< CV_8UC4: square roots of red, green, blue as in Backdrop::rgb, times
                  ///< coverage, then coverage; 255 is 1
};

/// Draws people: what all cameras share of a moment once (pose, shadows, light on every vertex),
/// then each camera's view of it.
///
/// Threads  The thread of the current gl::Context.
class PeopleRenderer {
 public:
  PeopleRenderer(const std::vector<CastMember>& cast, const std::vector<Lamp>& lamps,
                 const LightProbes& probes, const cv::Mat& floor_light);

  /// The empty hall's depth in each camera, so that what stands before people hides them.
  void addCamera(const StudioCamera& camera, const std::vector<float>& depth_m);

  void setMoment(const Moment& moment);
  /// The same people a few milliseconds later, in the light of the last setMoment().
  void movePeople(const Moment& moment);
  [[nodiscard]] const FloorShade& floorShade() const { return floor_shade_; }
  [[nodiscard]] std::vector<PeoplePicture> draw(std::size_t camera);
  /// Of people and hall, metres along the optical axis, the whole picture. CV_32F.
  [[nodiscard]] cv::Mat drawDepth(std::size_t camera);

 private:
  struct View {
    StudioCamera camera;
    gl::Texture depth;
  };
  void drawShadows();
  void lightBodies(double second);
  void shadeFloor(double second);
  void setLamps(const gl::Program& program, double second) const;
  void setCamera(const gl::Program& program, const StudioCamera& camera) const;
  void drawStep(const View& view, const PeopleArea& area, float instant) const;
  void makeTargets(int width, int height);

  const std::vector<CastMember>& cast_;
  const std::vector<Lamp>& lamps_;
  const LightProbes& probes_;
  std::vector<BodyMesh> surfaces_;
  std::vector<BodyMesh> shadows_;
  std::vector<View> views_;
  std::vector<ShownBody> shown_;
  FloorShade floor_shade_;

  gl::Program shadow_program_;
  gl::Program light_program_;
  gl::Program paint_program_;
  gl::Program floor_program_;
  gl::Program body_program_;
  gl::Program depth_program_;
  gl::Texture shadow_maps_;
  gl::Framebuffer shadow_framebuffer_;
  gl::Texture floor_light_;
  gl::Texture floor_map_;
  gl::Framebuffer floor_framebuffer_;
  gl::VertexArray no_vertices_;
  cv::Size target_size_;
  gl::Texture target_colour_;
  gl::Renderbuffer target_depth_;
  gl::Framebuffer target_;
};

}  // namespace emulator::studio
