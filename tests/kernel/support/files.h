#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace test {

/// Writes one attribute of configfs, sysfs or tracefs; throws what and where when it is refused.
inline void writeAttribute(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text << std::flush;
  if (!file) throw std::runtime_error("cannot write '" + text + "' to " + path);
}

/// One attribute without its line's end.
[[nodiscard]] inline std::string readAttribute(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace test
