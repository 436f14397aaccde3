#pragma once

#include <vector>

#include <Eigen/Core>

namespace emulator::studio {

/// A quantity over time through keys: quintic between neighbours, so that value, velocity and
/// acceleration are continuous; it never overshoots its keys (slopes after Fritsch & Butland
/// 1984, no acceleration at a key). Constant before the first and after the last key.
class Curve {
 public:
  Curve() = default;
  explicit Curve(double rest) : rest_(rest) {}

  /// Keys come in the order of time; one that is not later than the last replaces it.
  void key(double t, double value);

  [[nodiscard]] double at(double t) const;
  [[nodiscard]] double last() const { return keys_.empty() ? rest_ : keys_.back().value; }
  [[nodiscard]] bool empty() const { return keys_.empty(); }

 private:
  struct Key {
    double t;
    double value;
  };
  [[nodiscard]] double slope(std::size_t i) const;

  double rest_ = 0;
  std::vector<Key> keys_;
};

/// 0 at 0, 1 at 1, without velocity and acceleration at both ends.
[[nodiscard]] inline double ease(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * x * (x * (x * 6 - 15) + 10);
}

}  // namespace emulator::studio
