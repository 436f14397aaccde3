// A fuzz target without libFuzzer: gives it every file of its corpus, whole and cut off at many
// places, so that what was found once stays found in every build.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/fuzz_target.h"

namespace {

constexpr std::size_t kCuts = 64;  // of every file

std::vector<std::uint8_t> read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// In memory of its own size, so that a sanitizer sees the first byte past the end.
void give(const std::vector<std::uint8_t>& input, std::size_t size) {
  const std::vector<std::uint8_t> cut(input.begin(),
                                      input.begin() + static_cast<std::ptrdiff_t>(size));
  LLVMFuzzerTestOneInput(cut.data(), cut.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    (void)std::fprintf(stderr, "usage: %s CORPUS-FOLDER\n", argv[0]);
    return 2;
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    const std::vector<std::uint8_t> input = read(entry.path());
    std::printf("%s: %zu bytes\n", entry.path().filename().c_str(), input.size());
    (void)std::fflush(stdout);  // names the file before the crash
    give(input, input.size());
    for (std::size_t cut = 0; cut < kCuts; ++cut) give(input, input.size() * cut / kCuts);
    ++files;
  }
  if (files == 0) (void)std::fprintf(stderr, "%s: no corpus there\n", argv[1]);
  return files == 0 ? 1 : 0;
}
