// Draws the athlete from chosen sides, for people to look at:
//   athlete_view OUT.png [key=value ...]
// Keys: seed, sex=m|f, build, hair=short|full|tail, yaw (degrees, several with commas),
// from, height, distance (m), focal (px), size (px), t (s, several with commas; rest), action,
// hand=l|r, follow=1 (the person in the middle), joints (file for the pixels of the 17 joints, a
// line a view).
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <GLES3/gl3.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/athlete/albedo.h"
#include "hal/emulated/studio/athlete/body.h"
#include "hal/emulated/studio/athlete/performance.h"
#include "hal/gl/context.h"
#include "hal/gl/objects.h"

namespace {

using emulator::studio::AlbedoUniform;
using emulator::studio::Body;
using emulator::studio::BodyShape;
using emulator::studio::Vertex;

constexpr const char* kVertexSource = R"glsl(#version 300 es
precision highp float;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv_in;
layout(location = 3) in float material_in;
layout(location = 4) in vec3 rest_in;
uniform mat4 view;
out vec3 world;
out vec3 n;
out vec2 uv;
out vec3 rest;
flat out int material;
void main() {
  world = position;
  n = normal;
  uv = uv_in;
  rest = rest_in;
  material = int(material_in + 0.5);
  gl_Position = view * vec4(position, 1.0);
}
)glsl";

constexpr const char* kLightSource = R"glsl(
in vec3 world;
in vec3 n;
in vec2 uv;
in vec3 rest;
flat in int material;
uniform vec3 eye;
uniform int plain;
out vec4 colour;
void main() {
  vec3 normal = normalize(normalize(n) + (plain == 1 ? vec3(0.0) : athleteBump(material, rest)));
  vec3 albedo = plain == 1 ? vec3(0.5) : athleteAlbedo(material, uv, rest);
  vec3 to_eye = normalize(eye - world);
  vec3 light = vec3(0.22, 0.24, 0.27) * (0.65 + 0.35 * normal.z);
  float gloss = athleteGloss(material, rest);
  vec3 shine = vec3(0.0);
  vec3 lamps[3] = vec3[3](vec3(-2.0, -3.0, 5.0), vec3(3.0, -2.0, 5.0), vec3(0.5, 4.0, 5.0));
  float power[3] = float[3](0.95, 0.45, 0.5);
  for (int i = 0; i < 3; ++i) {
    vec3 l = normalize(lamps[i] - vec3(0.0, 0.0, 1.0));
    float d = dot(normal, l);
    float wrap = material == 0 ? 0.15 : 0.05;
    light += vec3(1.0, 0.97, 0.92) * power[i] * max((d + wrap) / (1.0 + wrap), 0.0);
    vec3 h = normalize(l + to_eye);
    shine += power[i] * gloss * 0.35 * pow(max(dot(normal, h), 0.0), 8.0 + 60.0 * gloss);
  }
  vec3 c = albedo * light + shine * 0.5;
  if (!gl_FrontFacing) c *= 0.35;
  colour = vec4(pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
)glsl";

struct Row {
  float position[3], normal[3], uv[2], material, rest[3];
};

using Bones = std::vector<Eigen::Affine3f>;

void append(const Body& body, const Bones& bones, std::vector<Row>& rows,
            std::vector<std::uint32_t>& triangles) {
  const auto first = static_cast<std::uint32_t>(rows.size());
  for (const Vertex& v : body.vertices) {
    Eigen::Vector3f p = v.position;
    Eigen::Vector3f n = v.normal;
    if (!bones.empty()) {
      p.setZero();
      n.setZero();
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& bone = bones[v.bones[i]];
        p += v.weights[i] * (bone * v.position);
        n += v.weights[i] * (bone.linear() * v.normal);
      }
    }
    rows.push_back({{p.x(), p.y(), p.z()},
                    {n.x(), n.y(), n.z()},
                    {v.uv.x(), v.uv.y()},
                    static_cast<float>(v.material),
                    {v.position.x(), v.position.y(), v.position.z()}});
  }
  for (const auto t : body.triangles) triangles.push_back(first + t);
}

Eigen::Matrix4f viewMatrix(const Eigen::Vector3f& eye, const Eigen::Vector3f& target, float focal,
                           float size) {
  const Eigen::Vector3f z = (target - eye).normalized();
  const Eigen::Vector3f x = z.cross(Eigen::Vector3f::UnitZ()).normalized();
  const Eigen::Vector3f y = x.cross(z);
  Eigen::Matrix4f look = Eigen::Matrix4f::Identity();
  look.block<1, 3>(0, 0) = x;
  look.block<1, 3>(1, 0) = y;
  look.block<1, 3>(2, 0) = -z;
  look.block<3, 1>(0, 3) = -look.block<3, 3>(0, 0) * eye;
  const float s = 2 * focal / size;
  const float near = 0.05F;
  const float far = 30;
  Eigen::Matrix4f lens = Eigen::Matrix4f::Zero();
  lens(0, 0) = s;
  lens(1, 1) = s;
  lens(2, 2) = -(far + near) / (far - near);
  lens(2, 3) = -2 * far * near / (far - near);
  lens(3, 2) = -1;
  return lens * look;
}

std::vector<float> numbers(const std::string& text) {
  std::vector<float> result;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) result.push_back(std::stof(part));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  std::map<std::string, std::string> options = {
      {"seed", "1"},   {"sex", "m"},  {"build", "0"},    {"hair", "short"}, {"yaw", "0,40,90,180"},
      {"height", "1"}, {"side", "0"}, {"distance", "4"}, {"focal", "1180"}, {"size", "640"},
      {"plain", "0"},  {"t", "rest"}, {"action", "all"}, {"follow", "0"},   {"columns", "8"},
      {"hand", "r"},   {"up", "0.2"}, {"scale", "1"}};
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    options[word.substr(0, equals)] = word.substr(equals + 1);
  }
  const auto number = [&](const char* key) { return std::stof(options[key]); };

  BodyShape shape;
  shape.seed = static_cast<std::uint64_t>(number("seed"));
  shape.sex = options["sex"] == "f" ? emulator::studio::Sex::kFemale : emulator::studio::Sex::kMale;
  shape.build = number("build");
  shape.cell_scale = number("scale");
  if (options["hair"] == "full") shape.hair_cut = emulator::studio::HairCut::kFull;
  if (options["hair"] == "tail") shape.hair_cut = emulator::studio::HairCut::kTail;
  shape.left_handed = options["hand"] == "l";
  emulator::studio::PerformanceOptions act;
  act.shape = shape;
  for (int a = 0; a <= static_cast<int>(emulator::studio::Action::kStretch); ++a) {
    const auto action = static_cast<emulator::studio::Action>(a);
    if (options["action"] == name(action)) act.actions = {action};
  }
  act.least_duration_s = act.actions.empty() ? 60 : 5;
  const emulator::studio::Performance performance(shape.seed, act);
  std::printf("%.2f s long\n", performance.duration());
  for (const auto& truth : performance.actions()) {
    std::printf("%6.2f %s\n", truth.from, std::string(name(truth.action)).c_str());
  }
  for (const auto& truth : performance.throws()) {
    std::printf("throw %.2f stride %.2f contact %.2f mer %.2f release %.2f end %.2f\n",
                truth.wind_up, truth.stride, truth.foot_contact, truth.max_external_rotation,
                truth.release, truth.end);
  }
  const auto start = std::chrono::steady_clock::now();
  const Body body = makeBody(shape);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%zu vertices, %zu triangles, %.2f s\n", body.vertices.size(),
              body.triangles.size() / 3, took.count());

  auto context = gl::Context::create(2);
  if (!context) {
    std::fprintf(stderr, "%s\n", context.error().c_str());
    return 1;
  }
  const auto made = gl::makeProgram("athlete", kVertexSource,
                                    std::string("#version 300 es\nprecision highp float;\n") +
                                        emulator::studio::athleteAlbedoSource() + kLightSource);
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().c_str());
    return 1;
  }
  const gl::Program& program = *made;
  glUseProgram(program.get());
  for (const AlbedoUniform& uniform : emulator::studio::albedoUniforms(shape)) {
    const GLint place = gl::uniform(program, uniform.name);
    if (uniform.components == 3)
      glUniform3fv(place, 1, uniform.value);
    else
      glUniform4fv(place, 1, uniform.value);
  }
  glUniform1i(gl::uniform(program, "plain"), static_cast<int>(number("plain")));

  const int size = static_cast<int>(number("size"));
  const int drawn = 2 * size;
  std::array<GLuint, 2> buffers{};
  glGenRenderbuffers(2, buffers.data());
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, drawn, drawn);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, drawn, drawn);
  GLuint frame = 0;
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  glViewport(0, 0, drawn, drawn);
  glEnable(GL_DEPTH_TEST);
  std::array<GLuint, 2> data{};
  glGenBuffers(2, data.data());
  glBindBuffer(GL_ARRAY_BUFFER, data[0]);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, data[1]);
  const std::array<std::array<int, 2>, 5> layout{{{3, 0}, {3, 3}, {2, 6}, {1, 8}, {3, 9}}};
  for (std::size_t i = 0; i < layout.size(); ++i) {
    glEnableVertexAttribArray(static_cast<GLuint>(i));
    glVertexAttribPointer(
        static_cast<GLuint>(i), layout[i][0], GL_FLOAT, GL_FALSE, sizeof(Row),
        reinterpret_cast<const void*>(static_cast<std::size_t>(layout[i][1]) * sizeof(float)));
  }

  std::vector<cv::Mat> pictures;
  std::FILE* joints =
      options["joints"].empty() ? nullptr : std::fopen(options["joints"].c_str(), "w");
  const bool at_rest = options["t"] == "rest";
  const Body ball = emulator::studio::makeBall();
  for (const float t : at_rest ? std::vector<float>{0} : numbers(options["t"]))
    for (const float yaw : numbers(options["yaw"])) {
      std::vector<Row> rows;
      std::vector<std::uint32_t> triangles;
      emulator::studio::PoseAt pose;
      if (!at_rest) pose = performance.at(static_cast<double>(t));
      append(body, pose.bones, rows, triangles);
      if (pose.ball_state != emulator::studio::BallState::kNone) {
        Eigen::Affine3f place = Eigen::Affine3f::Identity();
        place.linear() *= static_cast<float>(pose.ball_radius_m);
        place.translation() = pose.ball.cast<float>();
        append(ball, {place}, rows, triangles);
      }
      // The floor, for feet to stand on.
      const auto corner = static_cast<std::uint32_t>(rows.size());
      for (const float x : {-6.0F, 6.0F}) {
        for (const float y : {-6.0F, 6.0F}) {
          rows.push_back({{x, y, 0}, {0, 0, 1}, {x, y}, 7, {x, y, 0}});
        }
      }
      for (const std::uint32_t i : {0U, 2U, 3U, 0U, 3U, 1U}) triangles.push_back(corner + i);
      glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rows.size() * sizeof(Row)), rows.data(),
                   GL_STREAM_DRAW);
      glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * 4),
                   triangles.data(), GL_STREAM_DRAW);
      const float angle = yaw * 3.14159265F / 180;
      Eigen::Vector3f target{number("side"), 0, number("height")};
      if (options["follow"] != "0" && !at_rest) {
        target.head<2>() = (pose.joints[11] + pose.joints[12]).head<2>().cast<float>() / 2;
      }
      const Eigen::Vector3f eye =
          target + Eigen::Vector3f{std::sin(angle) * number("distance"),
                                   std::cos(angle) * number("distance"), number("up")};
      const Eigen::Matrix4f view =
          viewMatrix(eye, target, number("focal"), static_cast<float>(size));
      glUniformMatrix4fv(gl::uniform(program, "view"), 1, GL_FALSE, view.data());
      glUniform3fv(gl::uniform(program, "eye"), 1, eye.data());
      glClearColor(0.45F, 0.47F, 0.50F, 1);
      glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(triangles.size()), GL_UNSIGNED_INT,
                     nullptr);
      cv::Mat read(drawn, drawn, CV_8UC4);
      glReadPixels(0, 0, drawn, drawn, GL_RGBA, GL_UNSIGNED_BYTE, read.data);
      cv::Mat picture;
      cv::cvtColor(read, picture, cv::COLOR_RGBA2BGR);
      cv::flip(picture, picture, 0);
      cv::resize(picture, picture, cv::Size(size, size), 0, 0, cv::INTER_AREA);
      pictures.push_back(picture);
      if (joints != nullptr && !at_rest) {
        for (const auto& joint : pose.joints) {
          const Eigen::Vector4f clip = view * joint.cast<float>().homogeneous();
          std::fprintf(joints, "%.2f %.2f ",
                       static_cast<double>((clip.x() / clip.w() + 1) * number("size") / 2),
                       static_cast<double>((1 - clip.y() / clip.w()) * number("size") / 2));
        }
        std::fprintf(joints, "\n");
      }
    }
  if (joints != nullptr) std::fclose(joints);
  const auto columns = static_cast<std::size_t>(number("columns"));
  std::vector<cv::Mat> lines;
  for (std::size_t i = 0; i < pictures.size(); i += columns) {
    cv::Mat line;
    std::vector<cv::Mat> part(
        pictures.begin() + static_cast<std::ptrdiff_t>(i),
        pictures.begin() + static_cast<std::ptrdiff_t>(std::min(i + columns, pictures.size())));
    while (part.size() < columns && pictures.size() > columns)
      part.push_back(cv::Mat::zeros(size, size, CV_8UC3));
    cv::hconcat(part, line);
    lines.push_back(line);
  }
  cv::Mat sheet;
  cv::vconcat(lines, sheet);
  cv::imwrite(argv[1], sheet);
  return 0;
}
