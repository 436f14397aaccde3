#include "hal/emulated/studio/people_renderer.h"

#include <algorithm>
#include <cmath>
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
/// A point that goes further than this across the picture is drawn more than once.
constexpr double kStep_px = 2.2;
constexpr int kMostSteps = 8;
constexpr double kLensBlur_px = 0.62;

struct RestVertex {
  float rest[3];
  float uv[2];
  float material;
};

float value(double v) {
  return static_cast<float>(v);
}

/// A program of which only what the vertex shader gives is wanted.
gl::Program makeCapture(const char* name, const std::string& vertex, const char* captured) {
  gl::Program program = makeProgram(name, vertex, kNoFragment);
  glTransformFeedbackVaryings(program.get(), 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program.get());
  return program;
}

void capture(GLuint vertex_array, GLuint into, GLsizei vertices) {
  glEnable(GL_RASTERIZER_DISCARD);
  glBindVertexArray(vertex_array);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, into);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, vertices);
  glEndTransformFeedback();
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  glDisable(GL_RASTERIZER_DISCARD);
}

void attribute(GLuint index, GLint size, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
}

}  // namespace

void PeopleRenderer::restAttributes(const Mesh& mesh) {
  glBindBuffer(GL_ARRAY_BUFFER, mesh.rest.get());
  attribute(3, 3, sizeof(RestVertex), offsetof(RestVertex, rest));
  attribute(4, 2, sizeof(RestVertex), offsetof(RestVertex, uv));
  attribute(5, 1, sizeof(RestVertex), offsetof(RestVertex, material));
}

PeopleRenderer::Mesh PeopleRenderer::upload(const Body& body) {
  Mesh mesh{.draw = gl::makeVertexArray(),
            .light = gl::makeVertexArray(),
            .posed = gl::makeBuffer(),
            .fallen = gl::makeBuffer(),
            .rest = gl::makeBuffer(),
            .paint = gl::makeBuffer(),
            .indices = gl::makeBuffer(),
            .count = static_cast<GLsizei>(body.triangles.size()),
            .vertices = static_cast<GLsizei>(body.vertices.size())};
  const std::size_t count = body.vertices.size();
  const auto reserve = [&](const gl::Buffer& buffer, std::size_t vertex_bytes, GLenum use) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * vertex_bytes), nullptr, use);
  };
  const auto posedAttributes = [&] {
    glBindBuffer(GL_ARRAY_BUFFER, mesh.posed.get());
    attribute(0, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, opens));
    attribute(1, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, closes));
    attribute(2, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, normal));
  };
  reserve(mesh.posed, sizeof(PosedMesh::Vertex), GL_STREAM_DRAW);
  glBindVertexArray(mesh.light.get());
  posedAttributes();
  glBindVertexArray(mesh.draw.get());
  posedAttributes();
  std::vector<RestVertex> rest;
  rest.reserve(count);
  for (const Vertex& v : body.vertices) {
    rest.push_back({{v.position.x(), v.position.y(), v.position.z()},
                    {v.uv.x(), v.uv.y()},
                    static_cast<float>(v.material)});
  }
  glBindBuffer(GL_ARRAY_BUFFER, mesh.rest.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * sizeof(RestVertex)), rest.data(),
               GL_STATIC_DRAW);
  restAttributes(mesh);
  reserve(mesh.fallen, 3 * sizeof(float), GL_STREAM_COPY);
  attribute(6, 3, 3 * sizeof(float), 0);
  reserve(mesh.paint, 4 * sizeof(float), GL_STATIC_COPY);
  attribute(7, 4, 4 * sizeof(float), 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(body.triangles.size() * sizeof(std::uint32_t)),
               body.triangles.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  return mesh;
}

void PeopleRenderer::setColours(const gl::Program& program, const Body& body) {
  for (const AlbedoUniform& colour : albedoUniforms(body.shape)) {
    const GLint at = uniform(program, colour.name);
    if (colour.components == 3) {
      glUniform3fv(at, 1, colour.value);
    } else {
      glUniform4fv(at, 1, colour.value);
    }
  }
}

void PeopleRenderer::paint(const Mesh& mesh, const Body& body) const {
  const gl::VertexArray vertex_array = gl::makeVertexArray();
  glBindVertexArray(vertex_array.get());
  restAttributes(mesh);
  glUseProgram(paint_program_.get());
  setColours(paint_program_, body);
  capture(vertex_array.get(), mesh.paint.get(), mesh.vertices);
}

PeopleRenderer::PeopleRenderer(const std::vector<CastMember>& cast, const std::vector<Lamp>& lamps,
                               const LightProbes& probes, const cv::Mat& floor_light)
    : cast_(cast), lamps_(lamps), probes_(probes), no_vertices_(gl::makeVertexArray()) {
  for (const CastMember& member : cast) {
    surfaces_.push_back(upload(member.surface));
    shadows_.push_back(upload(member.shadow));
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
  for (std::size_t i = 0; i < cast.size(); ++i) paint(surfaces_[i], cast[i].surface);
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
  drawShadows(moment.second);
  lightBodies(moment.second);
  shadeFloor(moment.second);
}

void PeopleRenderer::movePeople(const Moment& moment) {
  shown_.resize(moment.bodies.size());
  const auto put = [](const Mesh& mesh, const PosedMesh& posed) {
    glBindBuffer(GL_ARRAY_BUFFER, mesh.posed.get());
    glBufferSubData(GL_ARRAY_BUFFER, 0,
                    static_cast<GLsizeiptr>(posed.vertices.size() * sizeof(PosedMesh::Vertex)),
                    posed.vertices.data());
  };
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const PosedBody& body = moment.bodies[i];
    Shown& shown = shown_[i];
    shown.body = body.body;
    poseMesh(cast_[body.body].surface, body.opens, body.closes, shown.mesh);
    poseMesh(cast_[body.body].shadow, body.opens, body.closes, shown.shadow);
    put(surfaces_[body.body], shown.mesh);
    put(shadows_[body.body], shown.shadow);
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

void PeopleRenderer::drawShadows(double /*second*/) {
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
    for (const Shown& shown : shown_) {
      const Mesh& mesh = shadows_[shown.body];
      glBindVertexArray(mesh.draw.get());
      glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
    }
  }
}

void PeopleRenderer::lightBodies(double second) {
  glUseProgram(light_program_.get());
  setLamps(light_program_, second);
  for (const Shown& shown : shown_) {
    const Eigen::Vector3f centre = shown.mesh.bounds.center();
    const LightProbes::Cube cube = probes_.at(centre.head<2>());
    glUniform3fv(uniform(light_program_, "around"), 6, cube[0].data());
    const Mesh& mesh = surfaces_[shown.body];
    capture(mesh.light.get(), mesh.fallen.get(), mesh.vertices);
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

/// Where people are in the picture: one rectangle each, those that overlap as one.
std::vector<PeopleRenderer::Area> PeopleRenderer::areasOf(const StudioCamera& camera) const {
  const cv::Rect picture(0, 0, static_cast<int>(camera.model.image_size.width),
                         static_cast<int>(camera.model.image_size.height));
  std::vector<Area> areas;
  for (const Shown& shown : shown_) {
    Eigen::AlignedBox2d box;
    bool behind = false;
    for (std::size_t i = 0; i < shown.mesh.vertices.size(); i += 5) {  // neighbours are near
      for (const Eigen::Vector3f& p :
           {shown.mesh.vertices[i].opens, shown.mesh.vertices[i].closes}) {
        const Eigen::Vector3d q = p.cast<double>();
        behind |= (camera.rotation().row(2) * (q - camera.centre()))(0) < kNear_m;
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

/// How many instants of the exposure make its blur: no two more than kStep_px apart.
int PeopleRenderer::stepsOf(const Area& area, const StudioCamera& camera) {
  double way_px = 0;
  for (const Shown* shown : area.people) {
    const double distance =
        std::max(0.5, (shown->mesh.bounds.center().cast<double>() - camera.centre()).norm() - 0.5);
    way_px = std::max(way_px, shown->mesh.way_m * camera.model.focal_px[0] / distance);
  }
  return std::clamp(static_cast<int>(std::ceil(way_px / kStep_px)), 1, kMostSteps);
}

std::vector<PeoplePicture> PeopleRenderer::draw(std::size_t camera) {
  const View& view = views_[camera];
  std::vector<PeoplePicture> pictures;
  for (const Area& area : areasOf(view.camera)) {
    const cv::Rect& rect = area.rect;
    const int steps = stepsOf(area, view.camera);
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

void PeopleRenderer::drawStep(const View& view, const Area& area, float instant) const {
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
  for (const Shown* shown : area.people) {
    const Mesh& mesh = surfaces_[shown->body];
    setColours(body_program_, cast_[shown->body].surface);
    glBindVertexArray(mesh.draw.get());
    glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
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
  for (const Shown& shown : shown_) {
    const Mesh& mesh = surfaces_[shown.body];
    glBindVertexArray(mesh.draw.get());
    glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
  }
  cv::Mat people(height, width, CV_32F);
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, people.data);
  cv::Mat hall(height, width, CV_32F);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, view.depth.get(), 0);
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, hall.data);
  return cv::min(people, hall);
}

}  // namespace emulator::studio
