#pragma once

#include <string>
#include <vector>

namespace test {

/// A real GPIO chip of the kernel whose wires are in our hands: the far end of every line is an
/// attribute of sysfs.
///
/// Errors   Everything throws std::runtime_error with what the kernel refused.
class GpioSim {
 public:
  /// @p lines are the lines' names, by offset; an empty one stays nameless.
  GpioSim(std::string label, std::vector<std::string> lines);
  ~GpioSim();
  GpioSim(const GpioSim&) = delete;
  GpioSim& operator=(const GpioSim&) = delete;

  /// Pulls the line's far end up or down: what an input reads, and an event where it changes.
  void pull(const std::string& line, bool up);
  /// The level that the line has now: driven where it is an output, pulled where it is an input.
  [[nodiscard]] bool level(const std::string& line) const;

  [[nodiscard]] const std::string& path() const { return path_; }    ///< "/dev/gpiochip0"
  [[nodiscard]] const std::string& label() const { return label_; }  ///< as libgpiod gives it
  /// The line's attributes ("pull", "value"), for programs that work them themselves.
  [[nodiscard]] std::string lineFolder(const std::string& line) const;

  /// The chip vanishes, as when its plug is pulled; only the destructor may be called then.
  void remove();

 private:
  std::string label_;
  std::vector<std::string> lines_;
  std::string config_;   // its folder in configfs
  std::string devices_;  // its folder in sysfs
  std::string path_;
  bool live_ = false;
};

}  // namespace test
