#include "ui-kms/warp_pass.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ui-kms/warp_shaders.h"

namespace ui {
namespace {

constexpr std::size_t kMostCorners = 65536;  // indices are 16 bits wide

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

GLsizeiptr bytesOf(const auto& values) {
  return static_cast<GLsizeiptr>(values.size() * sizeof(values[0]));
}

shader::Colour colourOf(const hal::ColourModel& colour) {
  const hal::ColourModel gains_alone{.gain_rgb = colour.gain_rgb};
  return colour == gains_alone ? shader::Colour::kGains : shader::Colour::kModel;
}

float narrow(double value) {
  return static_cast<float>(value);
}

}  // namespace

std::expected<WarpPass::Program, std::string> WarpPass::makeProgram(const char* pass,
                                                                    const std::string& vertex,
                                                                    const std::string& fragment) {
  auto made = gl::makeProgram(pass, vertex, fragment);
  if (!made) return std::unexpected(made.error());
  Program program;
  program.program = std::move(*made);
  const auto at = [&program](const char* name) { return uniform(program.program, name); };
  program.gain_rgb = at("gain_rgb");
  program.opacity = at("opacity");
  program.from_camera = at("from_camera");
  program.vignetting = at("vignetting");
  program.black = at("black");
  program.focal_px = at("focal_px");
  program.centre_px = at("centre_px");
  program.radial = at("radial");
  program.tangential = at("tangential");
  program.max_radius2 = at("max_radius2");
  program.source_px = at("source_px");
  program.narrowing = at("narrowing");
  return program;
}

std::expected<WarpPass, std::string> WarpPass::create() {
  using shader::Colour;
  WarpPass pass;
  auto& [gains, model] = pass.inner_;
  auto& [soft_gains, soft_model] = pass.soft_;
  const std::string inner = shader::innerVertex();
  const std::string soft = shader::softVertex();
  struct Wanted {
    Program& into;
    const char* name;
    std::string vertex, fragment;
  };
  for (const Wanted& wanted : {
           Wanted{gains[0], "warp", inner, shader::innerToScreen(Colour::kGains)},
           Wanted{gains[1], "warp linear", inner, shader::innerToLinear(Colour::kGains)},
           Wanted{model[0], "warp colour", inner, shader::innerToScreen(Colour::kModel)},
           Wanted{model[1], "warp colour linear", inner, shader::innerToLinear(Colour::kModel)},
           Wanted{soft_gains[0], "soft", soft, shader::softToScreen(Colour::kGains)},
           Wanted{soft_gains[1], "soft linear", soft, shader::softToLinear(Colour::kGains)},
           Wanted{soft_model[0], "soft colour", soft, shader::softToScreen(Colour::kModel)},
           Wanted{soft_model[1], "soft colour linear", soft, shader::softToLinear(Colour::kModel)},
           Wanted{pass.edge_[0], "warp edge", shader::edgeVertex(), shader::edgeToScreen()},
           Wanted{pass.edge_[1], "warp edge linear", shader::edgeVertex(), shader::edgeToLinear()},
       }) {
    auto program = makeProgram(wanted.name, wanted.vertex, wanted.fragment);
    if (!program) return std::unexpected(program.error());
    wanted.into = std::move(*program);
  }
  return pass;
}

std::expected<void, std::string> WarpPass::resize(SizePx picture, Orientation orientation) {
  const auto corners = [](std::uint32_t px) {
    return std::size_t{(px + WarpMesh::kCellPx - 1) / WarpMesh::kCellPx + 1};
  };
  if (corners(picture.width) * corners(picture.height) > kMostCorners) {
    return std::unexpected("a picture of " + std::to_string(picture.width) + "x" +
                           std::to_string(picture.height) + " px is more than can be drawn");
  }
  for (auto& mesh : meshes_) mesh.emplace(picture);
  positions_ = makePositions(meshes_[0]->cells, orientation);
  for (auto& mesh : meshes_) makeBuffers(*mesh);
  return {};
}

gl::Buffer WarpPass::makePositions(const WarpMesh& cells, Orientation orientation) {
  const double width_px = cells.columnPx(cells.columns() - 1) + 0.5;
  const double height_px = cells.rowPx(cells.rows() - 1) + 0.5;
  std::vector<std::array<float, 4>> positions;
  for (std::uint32_t j = 0; j < cells.rows(); ++j) {
    for (std::uint32_t i = 0; i < cells.columns(); ++i) {
      const float u = narrow((cells.columnPx(i) + 0.5) / width_px * 2 - 1);
      const float v = narrow((cells.rowPx(j) + 0.5) / height_px * 2 - 1);
      const auto [x, y] = orientation.turned(u, v);
      positions.push_back({x, y, u, v});
    }
  }
  gl::Buffer buffer = gl::makeBuffer();
  glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
  glBufferData(GL_ARRAY_BUFFER, bytesOf(positions), positions.data(), GL_STATIC_DRAW);
  return buffer;
}

void WarpPass::makeBuffers(Mesh& mesh) const {
  const std::size_t cells = std::size_t{mesh.cells.columns() - 1} * (mesh.cells.rows() - 1);
  mesh.layout = gl::makeVertexArray();
  mesh.vertices = gl::makeBuffer();
  mesh.indices = gl::makeBuffer();
  glBindVertexArray(mesh.layout.get());
  glBindBuffer(GL_ARRAY_BUFFER, positions_.get());
  glEnableVertexAttribArray(0);
  constexpr GLsizei kPosition = 4 * sizeof(float);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kPosition, nullptr);
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, kPosition, offset(2 * sizeof(float)));
  glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices.get());
  glBufferData(GL_ARRAY_BUFFER, bytesOf(mesh.cells.vertices()), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(WarpVertex),
                        offset(offsetof(WarpVertex, texture_u_w)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(WarpVertex),
                        offset(offsetof(WarpVertex, ray_x)));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(cells * 6 * sizeof(std::uint16_t)),
               nullptr, GL_STREAM_DRAW);
}

void WarpPass::draw(std::uint32_t index, const hal::ViewLayer& layer, GLuint source,
                    Output output) {
  Mesh& mesh = *meshes_[index];
  mesh.cells.update(layer.plan, layer.where);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, source);
  glBindVertexArray(mesh.layout.get());
  glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices.get());
  const std::size_t row = mesh.cells.columns();
  const std::size_t first = mesh.cells.firstRow() * row;
  const std::size_t count = (mesh.cells.lastRow() + 1) * row - first;
  glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof(WarpVertex)),
                  static_cast<GLsizeiptr>(count * sizeof(WarpVertex)),
                  &mesh.cells.vertices()[first]);
  const auto colour = static_cast<std::size_t>(colourOf(layer.plan.colour));
  const auto into = static_cast<std::size_t>(output);
  std::size_t at = 0;
  drawCells(mesh.cells.innerIndices(), inner_[colour][into], layer, at);
  drawCells(mesh.cells.softIndices(), soft_[colour][into], layer, at);
  drawCells(mesh.cells.edgeIndices(), edge_[into], layer, at);
}

/// @p at: where their indices go in the layout's buffer; then the place behind them.
void WarpPass::drawCells(const std::vector<std::uint16_t>& indices, const Program& program,
                         const hal::ViewLayer& layer, std::size_t& at) {
  if (indices.empty()) return;
  useFor(program, layer);
  glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLintptr>(at), bytesOf(indices),
                  indices.data());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_SHORT, offset(at));
  at += static_cast<std::size_t>(bytesOf(indices));
}

void WarpPass::useFor(const Program& program, const hal::ViewLayer& layer) {
  glUseProgram(program.program.get());
  if (program.gain_rgb >= 0) {
    glUniform3fv(program.gain_rgb, 1, layer.plan.colour.gain_rgb.data());
  } else {
    setColour(program, layer.plan);
  }
  if (program.opacity >= 0) glUniform1f(program.opacity, std::clamp(layer.opacity, 0.0F, 1.0F));
  if (program.narrowing >= 0) {
    static_assert(hal::EdgeMask::kPlaces == 64 && hal::EdgeMask::kFeather == 0.02F,
                  "the shaders have these numbers, too");
    glUniform1fv(program.narrowing, hal::EdgeMask::kPlaces, layer.plan.edge.narrowing.data());
  }
  if (program.focal_px >= 0) setLens(program, layer.plan);
}

void WarpPass::setColour(const Program& program, const hal::WarpPlan& plan) {
  const hal::ColourModel& colour = plan.colour;
  std::array<float, 9> from_camera{};
  for (std::size_t i = 0; i < from_camera.size(); ++i)
    from_camera[i] = colour.matrix[i] * colour.gain_rgb[i % 3];
  glUniformMatrix3fv(program.from_camera, 1, GL_TRUE, from_camera.data());
  glUniform3fv(program.vignetting, 1, colour.vignetting.data());
  glUniform1f(program.black, colour.black_level / 255);
  glUniform2f(program.centre_px, narrow(plan.lens.cx_px), narrow(plan.lens.cy_px));
  glUniform2f(program.source_px, static_cast<float>(plan.source.width_px),
              static_cast<float>(plan.source.height_px));
}

void WarpPass::setLens(const Program& program, const hal::WarpPlan& plan) {
  const auto [k1, k2, p1, p2, k3] = plan.lens.distortion;
  // A radius without a limit must not become an infinity inside the shader.
  const double max_radius2 = std::min(plan.lens.max_radius * plan.lens.max_radius, 1e30);
  glUniform2f(program.focal_px, narrow(plan.lens.fx_px), narrow(plan.lens.fy_px));
  glUniform3f(program.radial, narrow(k1), narrow(k2), narrow(k3));
  glUniform2f(program.tangential, narrow(p1), narrow(p2));
  glUniform1f(program.max_radius2, narrow(max_radius2));
}

}  // namespace ui
