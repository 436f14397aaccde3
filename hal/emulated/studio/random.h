#pragma once

#include <cstdint>

namespace emulator::studio {

/// Random numbers that are the same with every compiler and library: the standard distributions
/// are not. (splitmix64 by Steele, Lea and Flood, 2014.)
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e37'79b9'7f4a'7c15u);
    z = (z ^ (z >> 30)) * 0xbf58'476d'1ce4'e5b9u;
    z = (z ^ (z >> 27)) * 0x94d0'49bb'1331'11ebu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  [[nodiscard]] double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  [[nodiscard]] float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(unit());
  }
  /// Near to normal (sum of twelve), mean 0, deviation 1, never beyond 6.
  [[nodiscard]] double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += unit();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace emulator::studio
