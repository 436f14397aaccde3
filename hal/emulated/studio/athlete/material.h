#pragma once

#include <cstdint>

namespace emulator::studio {

/// What a surface is made of; the numbers are those of athleteAlbedo() in the shader.
enum class Material : std::uint8_t {
  kSkin,
  kEye,
  kHair,
  kShirt,
  kShorts,
  kSock,
  kShoe,
  kSole,
  kBall,
  kCount
};

}  // namespace emulator::studio
