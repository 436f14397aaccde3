#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/child_process.h"
#include "tests/support/depth_feed.h"

namespace test {

/// A folder of a test's own, gone with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = std::filesystem::temp_directory_path() / "kagami-depth-XXXXXX";
    path_ = ::mkdtemp(pattern.data());
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Runs kagami-depth to its end; false, with its words, where it failed.
inline testing::AssertionResult runDepth(const ScratchFolder& scratch,
                                         std::vector<std::string> words) {
  words.insert(words.begin(), KAGAMI_DEPTH);
  ChildProcess depth(words, scratch.file("kagami-depth.log"));
  const auto status = depth.wait(std::chrono::seconds(60));
  if (status == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << depth.output();
}

/// A second of the emulated sensor as an .oni file.
inline testing::AssertionResult recordOni(const ScratchFolder& scratch, const std::string& file,
                                          const emulator::RgbdFormat& format = DepthFeed::small()) {
  const DepthFeed feed(format);
  return runDepth(scratch, {"record", "--drivers", KAGAMI_DEPTH_DRIVERS, "--seconds", "1.5", file});
}

}  // namespace test
