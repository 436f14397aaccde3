#include "hal/emulated/studio/body_mesh.h"

#include <cstddef>
#include <string>
#include <vector>

#include "hal/emulated/studio/athlete/albedo.h"
#include "hal/emulated/studio/people_glsl.h"

namespace emulator::studio {
namespace {

struct RestVertex {
  float rest[3];
  float uv[2];
  float material;
};

void capture(const gl::VertexArray& vertex_array, const gl::Buffer& into, GLsizei vertices) {
  glEnable(GL_RASTERIZER_DISCARD);
  glBindVertexArray(vertex_array.get());
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, into.get());
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

void reserve(const gl::Buffer& buffer, std::size_t bytes, GLenum use) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, use);
}

}  // namespace

gl::Program makeCapture(const char* name, const std::string& vertex, const char* captured) {
  gl::Program program = makeProgram(name, vertex, kNoFragment);
  glTransformFeedbackVaryings(program.get(), 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program.get());
  return program;
}

void setColours(const gl::Program& program, const Body& body) {
  for (const AlbedoUniform& colour : albedoUniforms(body.shape)) {
    const GLint at = uniform(program, colour.name);
    if (colour.components == 3) {
      glUniform3fv(at, 1, colour.value);
    } else {
      glUniform4fv(at, 1, colour.value);
    }
  }
}

BodyMesh::BodyMesh(const Body& body)
    : draw_(gl::makeVertexArray()),
      light_(gl::makeVertexArray()),
      posed_(gl::makeBuffer()),
      fallen_(gl::makeBuffer()),
      rest_(gl::makeBuffer()),
      paint_(gl::makeBuffer()),
      indices_(gl::makeBuffer()),
      count_(static_cast<GLsizei>(body.triangles.size())),
      vertices_(static_cast<GLsizei>(body.vertices.size())) {
  const std::size_t count = body.vertices.size();
  reserve(posed_, count * sizeof(PosedMesh::Vertex), GL_STREAM_DRAW);
  glBindVertexArray(light_.get());
  posedAttributes();
  glBindVertexArray(draw_.get());
  posedAttributes();
  std::vector<RestVertex> rest;
  rest.reserve(count);
  for (const Vertex& v : body.vertices) {
    rest.push_back({{v.position.x(), v.position.y(), v.position.z()},
                    {v.uv.x(), v.uv.y()},
                    static_cast<float>(v.material)});
  }
  glBindBuffer(GL_ARRAY_BUFFER, rest_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * sizeof(RestVertex)), rest.data(),
               GL_STATIC_DRAW);
  restAttributes();
  reserve(fallen_, count * 3 * sizeof(float), GL_STREAM_COPY);
  attribute(6, 3, 3 * sizeof(float), 0);
  reserve(paint_, count * 4 * sizeof(float), GL_STATIC_COPY);
  attribute(7, 4, 4 * sizeof(float), 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(body.triangles.size() * sizeof(std::uint32_t)),
               body.triangles.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

void BodyMesh::posedAttributes() const {
  glBindBuffer(GL_ARRAY_BUFFER, posed_.get());
  attribute(0, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, opens));
  attribute(1, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, closes));
  attribute(2, 3, sizeof(PosedMesh::Vertex), offsetof(PosedMesh::Vertex, normal));
}

void BodyMesh::restAttributes() const {
  glBindBuffer(GL_ARRAY_BUFFER, rest_.get());
  attribute(3, 3, sizeof(RestVertex), offsetof(RestVertex, rest));
  attribute(4, 2, sizeof(RestVertex), offsetof(RestVertex, uv));
  attribute(5, 1, sizeof(RestVertex), offsetof(RestVertex, material));
}

void BodyMesh::pose(const PosedMesh& posed) {
  glBindBuffer(GL_ARRAY_BUFFER, posed_.get());
  glBufferSubData(GL_ARRAY_BUFFER, 0,
                  static_cast<GLsizeiptr>(posed.vertices.size() * sizeof(PosedMesh::Vertex)),
                  posed.vertices.data());
}

void BodyMesh::paint(const gl::Program& program, const Body& body) {
  const gl::VertexArray vertex_array = gl::makeVertexArray();
  glBindVertexArray(vertex_array.get());
  restAttributes();
  glUseProgram(program.get());
  setColours(program, body);
  capture(vertex_array, paint_, vertices_);
}

void BodyMesh::light() {
  capture(light_, fallen_, vertices_);
}

void BodyMesh::draw() const {
  glBindVertexArray(draw_.get());
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace emulator::studio
