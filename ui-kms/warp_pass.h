#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "hal/gl/objects.h"
#include "hal/scene.h"
#include "ui-kms/orientation.h"
#include "ui-kms/warp_mesh.h"

namespace ui {

/// Draws one view: backward map, bilinear in linear light, colour model, soft edge; then sRGB
/// encoding, or linear light for blending.
///
/// Threads  The one that has the context.
/// Memory   create() compiles; resize() makes the meshes of all layers.
class WarpPass {
 public:
  enum class Output : std::uint8_t {
    kScreen,  ///< sRGB, opaque
    kLinear,  ///< linear light times coverage and opacity, for glBlendFunc(ONE, 1 - SRC_ALPHA)
  };

  [[nodiscard]] static std::expected<WarpPass, std::string> create();

  /// @p picture: upright. Errors: one line; the size is as before.
  [[nodiscard]] std::expected<void, std::string> resize(SizePx picture, Orientation orientation);

  /// Into the bound framebuffer; the caller sets the scissor to the layer's rectangle.
  /// @p source: demosaiced, linear light, the plan's source size. @p index: of the layer.
  void draw(std::uint32_t index, const hal::ViewLayer& layer, GLuint source, Output output);

 private:
  struct Mesh {
    explicit Mesh(SizePx picture) : cells(picture.width, picture.height) {}
    WarpMesh cells;
    gl::VertexArray layout;
    gl::Buffer vertices;
    gl::Buffer indices;
  };
  struct Program {
    gl::Program program;
    GLint gain_rgb = -1, opacity = -1;
    // The whole colour model only.
    GLint from_camera = -1, vignetting = -1, black = -1, centre_px = -1, source_px = -1;
    // Soft and edge cells only.
    GLint narrowing = -1;
    // Edge cells only.
    GLint focal_px = -1, radial = -1, tangential = -1, max_radius2 = -1;
  };

  WarpPass() = default;
  [[nodiscard]] static std::expected<Program, std::string> makeProgram(const char* pass,
                                                                       const std::string& vertex,
                                                                       const std::string& fragment);
  [[nodiscard]] static gl::Buffer makePositions(const WarpMesh& cells, Orientation orientation);
  void makeBuffers(Mesh& mesh) const;
  void drawCells(const std::vector<std::uint16_t>& indices, const Program& program,
                 const hal::ViewLayer& layer, std::size_t& at);
  static void useFor(const Program& program, const hal::ViewLayer& layer);
  static void setColour(const Program& program, const hal::WarpPlan& plan);
  static void setLens(const Program& program, const hal::WarpPlan& plan);

  using ByColourAndOutput = std::array<std::array<Program, 2>, 2>;
  ByColourAndOutput inner_;
  ByColourAndOutput soft_;
  std::array<Program, 2> edge_;
  gl::Buffer positions_;  // of the corners: on the screen as it hangs, and upright
  std::array<std::optional<Mesh>, hal::Scene::kMostLayers> meshes_;
};

}  // namespace ui
