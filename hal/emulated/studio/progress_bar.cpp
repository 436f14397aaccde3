#include "hal/emulated/studio/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace emulator::studio {

std::string progressLine(double share, const char* what) {
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * kWidth));
  char text[96];
  std::snprintf(text, sizeof text, "[%s%s] %3.0f %% %s",
                std::string(static_cast<std::size_t>(full), '#').c_str(),
                std::string(static_cast<std::size_t>(kWidth - full), '-').c_str(),
                100 * std::clamp(share, 0.0, 1.0), what);
  return text;
}

ProgressBar::ProgressBar() : terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(double share, const char* what) {
  most_ = std::max(most_, share);  // several threads report, each its own part
  if (ended_) return;
  ended_ = most_ >= 1;
  const int steps = terminal_ ? 200 : 4;
  const int step = static_cast<int>(most_ * steps);
  if (step == last_step_ && !ended_) return;
  last_step_ = step;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (terminal_) {
    std::fprintf(stderr, "\rkagami-emulator: studio %s   %s", progressLine(most_, what).c_str(),
                 ended_ ? "\n" : "");
  } else {
    std::fprintf(stderr, "kagami-emulator: studio %s (%.0f s)\n", progressLine(most_, what).c_str(),
                 seconds);
  }
}

}  // namespace emulator::studio
