#include "hal/emulated/studio/people_renderer.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/athlete/albedo.h"
#include "hal/emulated/studio/hall_size.h"
#include "hal/emulated/studio/lens_glsl.h"
#include "hal/emulated/studio/people_glsl.h"
#include "hal/emulated/studio/shadow_glsl.h"

namespace emulator::studio {
namespace {

constexpr int kShadowSide = 1024;
constexpr std::array<float, 4> kShadowArea = {0, 1.0f, 7.5f, 7.0f};  // middle, half sizes
constexpr float kTallest_m = 2.9f;
constexpr float kNear_m = 0.3f;
constexpr float kFar_m = 30;
constexpr double kLensBlur_px = 0.62;

float value(double v) {
  return static_cast<float>(v);
}

}  // namespace

PeopleRenderer::PeopleRenderer(const std::vector<CastMember>& cast, const std::vector<Lamp>& lamps,
                               const LightProbes& probes, const cv::Mat& floor_light)
    : cast_(cast), lamps_(lamps), probes_(probes), no_vertices_(gl::makeVertexArray()) {
  for (const CastMember& member : cast) {
    surfaces_.emplace_back(member.surface);
    shadows_.emplace_back(member.shadow);
  }
  shadow_program_ = makeProgram("shadows", kShadowVertex, kShadowFragment);
  light_program_ =
      makeCapture("light of people", std::string(kShadowGlsl) + kLightVertex, "fallen");
  paint_program_ =
      makeCapture("paint of people", std::string(athleteAlbedoSource()) + kPaintVertex, "paint");
  const char* const everywhere =
      "void main() { gl_Position = vec4(vec2(float((gl_VertexID & 1) << 2) - 1.0, "
      "float((gl_VertexID & 2) << 1) - 1.0), 0.0, 1.0); }";
  floor_program_ = makeProgram("floor", everywhere, std::string(kShadowGlsl) + kFloorFragment);
  body_program_ = makeProgram("people", std::string(kLensGlsl) + kBodyVertex,
                              std::string(athleteAlbedoSource()) + kBodyFragment);
  depth_program_ = makeProgram("depth", std::string(kLensGlsl) + kBodyVertex, kDepthFragment);

  GLuint maps = 0;
  glGenTextures(1, &maps);
  shadow_maps_ = gl::Texture(maps);
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_DEPTH_COMPONENT32F, kShadowSide, kShadowSide,
                 kKeyLamps);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  shadow_framebuffer_ = gl::makeFramebuffer();

  floor_light_ =
      gl::makeTexture(GL_R32F, floor_light.cols, floor_light.rows, GL_NEAREST, GL_CLAMP_TO_EDGE);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, floor_light.cols, floor_light.rows, GL_RED, GL_FLOAT,
                  floor_light.data);
  floor_map_ = gl::makeTexture(GL_RGBA32F, FloorShade::kColumns, FloorShade::kRows, GL_NEAREST,
                               GL_CLAMP_TO_EDGE);
  floor_framebuffer_ = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, floor_framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, floor_map_.get(), 0);
  for (std::size_t i = 0; i < cast.size(); ++i) surfaces_[i].paint(paint_program_, cast[i].surface);
}

void PeopleRenderer::makeTargets(int width, int height) {
  if (target_size_.width >= width && target_size_.height >= height) return;
  target_size_ = {std::max(width, target_size_.width), std::max(height, target_size_.height)};
  target_colour_ = gl::makeTexture(GL_RGBA8, target_size_.width, target_size_.height, GL_NEAREST,
                                   GL_CLAMP_TO_EDGE);
  target_depth_ = gl::makeRenderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, target_depth_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, target_size_.width,
                        target_size_.height);
  target_ = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, target_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target_colour_.get(),
                         0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                            target_depth_.get());
}

void PeopleRenderer::addCamera(const StudioCamera& camera, const std::vector<float>& depth_m) {
  const auto width = static_cast<int>(camera.model.image_size.width);
  const auto height = static_cast<int>(camera.model.image_size.height);
  View view{.camera = camera,
            .depth = gl::makeTexture(GL_R32F, width, height, GL_NEAREST, GL_CLAMP_TO_EDGE)};
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_FLOAT, depth_m.data());
  views_.push_back(std::move(view));
  makeTargets(width, height);
}

void PeopleRenderer::setMoment(const Moment& moment) {
  movePeople(moment);
  drawShadows();
  lightBodies(moment.second);
  shadeFloor(moment.second);
}

void PeopleRenderer::movePeople(const Moment& moment) {
  shown_.resize(moment.bodies.size());
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const PosedBody& body = moment.bodies[i];
    ShownBody& shown = shown_[i];
    shown.body = body.body;
    poseMesh(cast_[body.body].surface, body.opens, body.closes, shown.mesh);
    poseMesh(cast_[body.body].shadow, body.opens, body.closes, shown.shadow);
    surfaces_[body.body].pose(shown.mesh);
    shadows_[body.body].pose(shown.shadow);
  }
}

void PeopleRenderer::setLamps(const gl::Program& program, double second) const {
  std::array<float, 3 * kKeyLamps> at{};
  std::array<float, 3 * kKeyLamps> light{};
  std::array<float, 2 * kKeyLamps> half{};
  for (std::size_t i = 0; i < kKeyLamps; ++i) {
    const Lamp& lamp = lamps_[i];
    const float area = 4 * lamp.half_u.norm() * lamp.half_v.norm();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto k = static_cast<Eigen::Index>(c);
      at[3 * i + c] = lamp.centre[k];
      light[3 * i + c] = lamp.radiance[k] * area * lamp.ripple(second) / std::numbers::pi_v<float>;
    }
    half[2 * i] = lamp.half_u.x();
    half[2 * i + 1] = lamp.half_v.y();
  }
  glUniform3fv(uniform(program, "lamp_at"), kKeyLamps, at.data());
  glUniform3fv(uniform(program, "lamp_light"), kKeyLamps, light.data());
  glUniform2fv(uniform(program, "lamp_half"), kKeyLamps, half.data());
  glUniform4fv(uniform(program, "shadow_area"), 1, kShadowArea.data());
  glUniform2f(uniform(program, "shadow_depth"), kLampHeight_m - kTallest_m, kLampHeight_m + 0.05f);
  glUniform1i(uniform(program, "shadows"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, shadow_maps_.get());
}

void PeopleRenderer::drawShadows() {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_framebuffer_.get());
  glViewport(0, 0, kShadowSide, kShadowSide);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glUseProgram(shadow_program_.get());
  glUniform4fv(uniform(shadow_program_, "shadow_area"), 1, kShadowArea.data());
  glUniform2f(uniform(shadow_program_, "shadow_depth"), kLampHeight_m - kTallest_m,
              kLampHeight_m + 0.05f);
  const GLfloat kDeep = 1;
  const GLenum kNothing = GL_NONE;
  for (std::size_t i = 0; i < kKeyLamps; ++i) {
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, shadow_maps_.get(), 0,
                              static_cast<GLint>(i));
    glDrawBuffers(1, &kNothing);
    glClearBufferfv(GL_DEPTH, 0, &kDeep);
    const Lamp& lamp = lamps_[i];
    glUniform3f(uniform(shadow_program_, "lamp"), lamp.centre.x(), lamp.centre.y(),
                lamp.centre.z());
    for (const ShownBody& shown : shown_) shadows_[shown.body].draw();
  }
}

void PeopleRenderer::lightBodies(double second) {
  glUseProgram(light_program_.get());
  setLamps(light_program_, second);
  for (const ShownBody& shown : shown_) {
    const Eigen::Vector3f centre = shown.mesh.bounds.center();
    const LightProbes::Cube cube = probes_.at(centre.head<2>());
    glUniform3fv(uniform(light_program_, "around"), 6, cube[0].data());
    surfaces_[shown.body].light();
  }
}

void PeopleRenderer::shadeFloor(double second) {
  glBindFramebuffer(GL_FRAMEBUFFER, floor_framebuffer_.get());
  glViewport(0, 0, FloorShade::kColumns, FloorShade::kRows);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(floor_program_.get());
  setLamps(floor_program_, second);
  glUniform4f(uniform(floor_program_, "floor_area"), FloorShade::kLowX_m, FloorShade::kLowY_m,
              FloorShade::kColumns * FloorShade::kStep_m, FloorShade::kRows * FloorShade::kStep_m);
  glUniform4f(uniform(floor_program_, "hall_area"), kHallLeft_m, kHallFront_m,
              kHallRight_m - kHallLeft_m, kHallBack_m - kHallFront_m);
  glUniform2f(uniform(floor_program_, "map_size"), FloorShade::kColumns, FloorShade::kRows);
  glUniform1i(uniform(floor_program_, "floor_light"), 1);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, floor_light_.get());
  glBindVertexArray(no_vertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  cv::Mat rgba(FloorShade::kRows, FloorShade::kColumns, CV_32FC4);
  glReadPixels(0, 0, FloorShade::kColumns, FloorShade::kRows, GL_RGBA, GL_FLOAT, rgba.data);
  cv::extractChannel(rgba, floor_shade_.share, 0);
}

void PeopleRenderer::setCamera(const gl::Program& program, const StudioCamera& camera) const {
  const CameraModel& m = camera.model;
  const Eigen::Matrix3f rotation = camera.rotation().cast<float>();
  const Eigen::Vector3f eye = camera.centre().cast<float>();
  glUniformMatrix3fv(uniform(program, "rotation"), 1, GL_FALSE, rotation.data());
  glUniform3f(uniform(program, "translation"), value(m.translation_m[0]), value(m.translation_m[1]),
              value(m.translation_m[2]));
  glUniform4f(uniform(program, "camera_f"), value(m.focal_px[0]), value(m.focal_px[1]),
              value(m.centre_px[0]), value(m.centre_px[1]));
  glUniform4f(uniform(program, "camera_k"), value(m.distortion[0]), value(m.distortion[1]),
              value(m.distortion[2]), value(m.distortion[3]));
  glUniform2f(uniform(program, "picture_size"), value(m.image_size.width),
              value(m.image_size.height));
  glUniform2f(uniform(program, "near_far"), kNear_m, kFar_m);
  glUniform3f(uniform(program, "eye"), eye.x(), eye.y(), eye.z());
}

std::vector<PeoplePicture> PeopleRenderer::draw(std::size_t camera) {
  const View& view = views_[camera];
  std::vector<PeoplePicture> pictures;
  for (const PeopleArea& area : peopleAreas(view.camera, shown_, kNear_m)) {
    const cv::Rect& rect = area.rect;
    const int steps = blurSteps(area, view.camera);
    PeoplePicture picture{.area = rect, .roots = cv::Mat(rect.size(), CV_8UC4)};
    cv::Mat sum;
    if (steps > 1) sum = cv::Mat(rect.size(), CV_32FC4, cv::Scalar::all(0));
    for (int step = 0; step < steps; ++step) {
      drawStep(view, area, value((step + 0.5) / steps));
      glReadPixels(rect.x, rect.y, rect.width, rect.height, GL_RGBA, GL_UNSIGNED_BYTE,
                   picture.roots.data);
      if (steps > 1) cv::accumulate(picture.roots, sum);
    }
    if (steps > 1) sum.convertTo(picture.roots, CV_8U, 1.0 / steps);
    // As soft as the lens draws the hall; it also rounds off the stairs of the outlines.
    cv::GaussianBlur(picture.roots, picture.roots, {3, 3}, kLensBlur_px, kLensBlur_px,
                     cv::BORDER_REPLICATE);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

void PeopleRenderer::drawStep(const View& view, const PeopleArea& area, float instant) const {
  const SizePx size = view.camera.model.image_size;
  glBindFramebuffer(GL_FRAMEBUFFER, target_.get());
  glViewport(0, 0, static_cast<GLsizei>(size.width), static_cast<GLsizei>(size.height));
  glEnable(GL_SCISSOR_TEST);
  glScissor(area.rect.x, area.rect.y, area.rect.width, area.rect.height);
  const GLfloat kClear[] = {0, 0, 0, 0};
  const GLfloat kDeep = 1;
  glClearBufferfv(GL_COLOR, 0, kClear);
  glClearBufferfv(GL_DEPTH, 0, &kDeep);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // rows run downwards
  glUseProgram(body_program_.get());
  setCamera(body_program_, view.camera);
  glUniform1f(uniform(body_program_, "instant"), instant);
  glUniform1i(uniform(body_program_, "behind"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, view.depth.get());
  for (const ShownBody* shown : area.people) {
    setColours(body_program_, cast_[shown->body].surface);
    surfaces_[shown->body].draw();
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
}

cv::Mat PeopleRenderer::drawDepth(std::size_t camera) {
  const View& view = views_[camera];
  const auto width = static_cast<int>(view.camera.model.image_size.width);
  const auto height = static_cast<int>(view.camera.model.image_size.height);
  const gl::Texture target = gl::makeTexture(GL_R32F, width, height, GL_NEAREST, GL_CLAMP_TO_EDGE);
  const gl::Renderbuffer depth = gl::makeRenderbuffer();
  glBindRenderbuffer(GL_RENDERBUFFER, depth.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  const gl::Framebuffer framebuffer = gl::makeFramebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.get(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.get());
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  const GLfloat kFarAway[] = {kFar_m, 0, 0, 0};
  const GLfloat kDeep = 1;
  glClearBufferfv(GL_COLOR, 0, kFarAway);
  glClearBufferfv(GL_DEPTH, 0, &kDeep);
  glUseProgram(depth_program_.get());
  setCamera(depth_program_, view.camera);
  glUniform1f(uniform(depth_program_, "instant"), 0.5f);
  for (const ShownBody& shown : shown_) surfaces_[shown.body].draw();
  cv::Mat people(height, width, CV_32F);
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, people.data);
  cv::Mat hall(height, width, CV_32F);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, view.depth.get(), 0);
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, hall.data);
  return cv::min(people, hall);
}

}  // namespace emulator::studio
