#pragma once

#include <expected>
#include <memory>
#include <string>

#include "hal/gl/context.h"
#include "hal/gl/objects.h"

namespace emulator::studio {

/// A context that draws on its caller's thread alone: there is one for every processor.
/// Errors   Says in one line what is missing on this machine, and which scene needs none of it.
[[nodiscard]] std::expected<std::unique_ptr<gl::Context>, std::string> openContext();

/// Of the studio's own shaders, which begin with highp precision of all they use: one that does
/// not compile is our bug, and the program ends with its message.
[[nodiscard]] gl::Program makeProgram(const char* name, const std::string& vertex,
                                      const std::string& fragment);

}  // namespace emulator::studio
