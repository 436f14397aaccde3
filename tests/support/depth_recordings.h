#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/depth_feed.h"
#include "tests/support/temporary_folder.h"

namespace test {

/// Runs kagami-depth to its end; false, with its words, where it failed.
inline testing::AssertionResult runDepth(const TemporaryFolder& scratch,
                                         std::vector<std::string> words) {
  words.insert(words.begin(), KAGAMI_DEPTH);
  ChildProcess depth(words, scratch / "kagami-depth.log");
  const auto status = depth.wait(std::chrono::seconds(60));
  if (status == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << depth.output();
}

/// A second and a half of the emulated sensor as an .oni file, however long it takes to write.
inline testing::AssertionResult recordOni(const TemporaryFolder& scratch, const std::string& file,
                                          const emulator::RgbdFormat& format = DepthFeed::small()) {
  const DepthFeed feed(format);
  return runDepth(scratch, {"record", "--drivers", KAGAMI_DEPTH_DRIVERS, "--seconds", "50",
                            "--pictures", "45", file});
}

}  // namespace test
