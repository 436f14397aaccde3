#pragma once

#include <string>

namespace ui {

/// The shaders of WarpPass in GLSL ES 3, put together from pieces: what a pixel of the camera looks
/// like (one text for all), where that pixel is (inner cells or edge cells), and where the result
/// goes (the screen or a target of linear light).
namespace shader {

[[nodiscard]] std::string innerVertex();
[[nodiscard]] std::string edgeVertex();
/// sRGB, opaque.
[[nodiscard]] std::string innerToScreen();
[[nodiscard]] std::string edgeToScreen();
/// Linear light times the layer's opacity, to be blended.
[[nodiscard]] std::string innerToLinear();
[[nodiscard]] std::string edgeToLinear();
/// All pixels of the target, without attributes.
[[nodiscard]] std::string everywhereVertex();
/// The finished target of linear light as sRGB.
[[nodiscard]] std::string linearToScreen();

}  // namespace shader
}  // namespace ui
