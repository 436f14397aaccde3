#pragma once

#include <cstdint>
#include <string>

namespace ui {

/// The shaders of WarpPass in GLSL ES 3, put together from pieces: what a pixel of the camera looks
/// like (one text for all), where that pixel is (inner cells or edge cells), and where the result
/// goes (the screen or a target of linear light).
namespace shader {

/// What the screen shows beside a picture: dark grey, as an sRGB code of 0 to 1 and in linear
/// light.
inline constexpr float kSurroundCode = 18.0F / 255;
inline constexpr float kSurroundLight = 0.006048F;

[[nodiscard]] std::string innerVertex();
[[nodiscard]] std::string softVertex();
[[nodiscard]] std::string edgeVertex();
/// How a stored value becomes linear light.
enum class Colour : std::uint8_t {
  kGains,  ///< by gains alone: what costs least
  kModel,  ///< by the whole hal::ColourModel
};

/// sRGB, opaque.
[[nodiscard]] std::string innerToScreen(Colour colour);
[[nodiscard]] std::string softToScreen(Colour colour);
[[nodiscard]] std::string edgeToScreen();
/// Linear light times the layer's opacity, to be blended.
[[nodiscard]] std::string innerToLinear(Colour colour);
[[nodiscard]] std::string softToLinear(Colour colour);
[[nodiscard]] std::string edgeToLinear();
/// All pixels of the target, without attributes.
[[nodiscard]] std::string everywhereVertex();
/// The finished target of linear light as sRGB.
[[nodiscard]] std::string linearToScreen();

}  // namespace shader
}  // namespace ui
