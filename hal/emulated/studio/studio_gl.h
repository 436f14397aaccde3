#pragma once

#include <expected>
#include <memory>
#include <string>

#include "hal/gl/context.h"
#include "hal/gl/objects.h"

namespace emulator::studio {

/// A context for the calling thread. Mesa's software renderer computes a context's vertices there,
/// and its pixels on as many threads as there are processors, for one context at a time; the first
/// context of a process makes these threads, which inherit its caller's nice value.
/// Errors   Says in one line what is missing on this machine, and which scene needs none of it.
[[nodiscard]] std::expected<std::unique_ptr<gl::Context>, std::string> openContext();

/// The renderer of this machine, with its version: pictures are equal bit for bit only if this is
/// equal. Otherwise as openContext(); the renderer's threads always yield to others.
[[nodiscard]] std::expected<std::string, std::string> rendererName();

/// The calling thread does so, too.
void letOthersGoFirst();

/// Of the studio's own shaders, which begin with highp precision of all they use: one that does
/// not compile is our bug, and the program ends with its message.
[[nodiscard]] gl::Program makeProgram(const char* name, const std::string& vertex,
                                      const std::string& fragment);

}  // namespace emulator::studio
