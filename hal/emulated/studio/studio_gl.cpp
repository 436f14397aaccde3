#include "hal/emulated/studio/studio_gl.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <sys/resource.h>

namespace emulator::studio {
namespace {

constexpr const char* kPreamble =
    "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
    "precision highp sampler2DShadow;\nprecision highp sampler2DArrayShadow;\nprecision highp "
    "sampler2DArray;\n";

}  // namespace

std::expected<std::unique_ptr<gl::Context>, std::string> openContext() {
  constexpr unsigned kMostThreads = 16;
  auto context =
      gl::Context::create(std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads));
  if (context) return context;
  return std::unexpected("the studio cannot be drawn: " + context.error() +
                         ", or take --scene stamp, which needs neither");
}

std::expected<std::string, std::string> rendererName() {
  std::expected<std::string, std::string> name;
  std::jthread([&name] {
    letOthersGoFirst();
    const auto context = openContext();
    if (context) {
      name = (*context)->renderer() + ", " + (*context)->version();
    } else {
      name = std::unexpected(context.error());
    }
  }).join();
  return name;
}

void letOthersGoFirst() {
  ::setpriority(PRIO_PROCESS, 0, 10);  // on Linux: of this thread
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
