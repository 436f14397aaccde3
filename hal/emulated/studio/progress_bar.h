#pragma once

#include <chrono>
#include <string>

namespace emulator::studio {

/// One line on stderr that fills up; where stderr is no terminal, a line for every quarter.
class ProgressBar {
 public:
  ProgressBar();
  /// @p share  0..1; 1 ends the line.
  void show(double share, const char* what);

 private:
  bool terminal_;
  bool ended_ = false;
  int last_step_ = -1;
  double most_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// "[######----] 60 % what": 30 characters for the whole.
[[nodiscard]] std::string progressLine(double share, const char* what);

}  // namespace emulator::studio
