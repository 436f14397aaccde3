#include "hal/emulated/studio/studio_gl.h"

#include <cstdio>
#include <cstdlib>

namespace emulator::studio {
namespace {

constexpr const char* kPreamble =
    "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
    "precision highp sampler2DShadow;\nprecision highp sampler2DArrayShadow;\nprecision highp "
    "sampler2DArray;\n";

}  // namespace

std::expected<std::unique_ptr<gl::Context>, std::string> openContext() {
  auto context = gl::Context::create(0);
  if (context) return context;
  return std::unexpected("the studio cannot be drawn: " + context.error() +
                         ", or take --scene stamp, which needs neither");
}

gl::Program makeProgram(const char* name, const std::string& vertex, const std::string& fragment) {
  auto program = gl::makeProgram(name, kPreamble + vertex, kPreamble + fragment);
  if (!program) {
    std::fprintf(stderr, "kagami-emulator: %s\n", program.error().c_str());
    std::abort();
  }
  return std::move(*program);
}

}  // namespace emulator::studio
