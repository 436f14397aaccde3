#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace test {

/// What a shell's @p command writes to both its outputs.
inline std::string outputOf(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 4096> chunk{};
  while (std::fgets(chunk.data(), chunk.size(), pipe) != nullptr) text += chunk.data();
  pclose(pipe);
  return text;
}

}  // namespace test
