#pragma once

#include "hal/emulated/studio/athlete/body.h"
#include "hal/emulated/studio/posed_mesh.h"
#include "hal/emulated/studio/studio_gl.h"

namespace emulator::studio {

/// A body as the graphics side keeps it: what never changes (rest pose, triangles, paint), where
/// its vertices are now, and what light falls on each.
///
/// Threads  The thread of the current gl::Context.
class BodyMesh {
 public:
  explicit BodyMesh(const Body& body);

  void pose(const PosedMesh& posed);
  /// Puts the body's colours on its vertices, by a program of makeCapture() with kPaintVertex.
  void paint(const gl::Program& program, const Body& body);
  /// Puts light on the vertices where they are now, by a program of makeCapture() with
  /// kLightVertex.
  void light();
  /// All triangles, by the program in use.
  void draw() const;

 private:
  void posedAttributes() const;
  void restAttributes() const;

  gl::VertexArray draw_;
  gl::VertexArray light_;
  gl::Buffer posed_;
  gl::Buffer fallen_;
  gl::Buffer rest_;
  gl::Buffer paint_;
  gl::Buffer indices_;
  GLsizei count_;
  GLsizei vertices_;
};

/// A program of which only what the vertex shader gives is wanted.
[[nodiscard]] gl::Program makeCapture(const char* name, const std::string& vertex,
                                      const char* captured);
/// Skin, hair and clothes of a body, for a program that draws or paints it.
void setColours(const gl::Program& program, const Body& body);

}  // namespace emulator::studio
